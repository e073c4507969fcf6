// TILE directions of an image at once; of a kernel with the bindings `directions` and `directionQuads` (the same memory,
// as single floats and as texels of four) and the push constants SgMixturePush.
#ifndef STRANDLIGHT_NN_SG_DIRECTIONS_GLSL
#define STRANDLIGHT_NN_SG_DIRECTIONS_GLSL

vec3 direction[TILE];

const uint OF_FOUR = TILE < 4 ? TILE : 4; // different directions of the four that a lobe is evaluated for at once

struct Chords
{
    vec4 x, y, z; // direction - axis
    vec4 squared;
};

// To four directions from j on; of a tile of one four times to the same, which costs no more than once.
Chords chordsTo(vec3 axis, uint j)
{
    vec3 a = direction[j % TILE] - axis, b = direction[(j + 1) % TILE] - axis;
    vec3 c = direction[(j + 2) % TILE] - axis, d = direction[(j + 3) % TILE] - axis;
    Chords chords;
    chords.x = vec4(a.x, b.x, c.x, d.x);
    chords.y = vec4(a.y, b.y, c.y, d.y);
    chords.z = vec4(a.z, b.z, c.z, d.z);
    chords.squared = chords.x * chords.x + chords.y * chords.y + chords.z * chords.z;
    return chords;
}

void loadDirections(uint n, uint first)
{
    int at = int(n * push.directionImageStride + first * 3);
    if (TILE % 4 == 0) {
        float values[3 * TILE + 3];
        [[unroll]] for (uint j = 0; j < 3 * TILE; j += 4) {
            vec4 quad = imageLoad(directionQuads, at / 4 + int(j / 4));
            [[unroll]] for (uint i = 0; i < 4; ++i)
                values[j + i] = quad[i];
        }
        [[unroll]] for (uint j = 0; j < TILE; ++j)
            direction[j] = vec3(values[3 * j], values[3 * j + 1], values[3 * j + 2]);
    } else {
        direction[0] = vec3(imageLoad(directions, at).x, imageLoad(directions, at + 1).x, imageLoad(directions, at + 2).x);
    }
}

#endif
