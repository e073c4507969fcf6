// TILE directions of an image at once; of a kernel with the bindings `directions` and `directionQuads` (the same memory,
// as single floats and as texels of four) and the push constants SgMixturePush.
#ifndef STRANDLIGHT_NN_SG_DIRECTIONS_GLSL
#define STRANDLIGHT_NN_SG_DIRECTIONS_GLSL

vec3 direction[TILE];

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
