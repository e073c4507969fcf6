// TILE directions of an image at once; of a kernel with the bindings `directions` and `directionQuads` (the same memory,
// as single floats and as texels of four) and the push constants SgMixturePush.
#ifndef STRANDLIGHT_NN_SG_DIRECTIONS_GLSL
#define STRANDLIGHT_NN_SG_DIRECTIONS_GLSL

vec3 direction[TILE];

void loadDirections(uint n, uint first)
{
    int at = int(n * push.directionImageStride + first * 3);
    if (TILE == 4) {
        vec4 a = imageLoad(directionQuads, at / 4);
        vec4 b = imageLoad(directionQuads, at / 4 + 1);
        vec4 c = imageLoad(directionQuads, at / 4 + 2);
        direction[0] = a.xyz;
        direction[1 % TILE] = vec3(a.w, b.xy);
        direction[2 % TILE] = vec3(b.zw, c.x);
        direction[3 % TILE] = c.yzw;
    } else {
        direction[0] = vec3(imageLoad(directions, at).x, imageLoad(directions, at + 1).x, imageLoad(directions, at + 2).x);
    }
}

#endif
