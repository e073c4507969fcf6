// Triangles of the scene in leaf order, as the rasteriser and the resolve pass fetch them (trace_types.h, light_types.h).
// The includer names the texel buffers SCENE_TRIANGLES and SCENE_CORNERS (rgba32ui).
#ifndef STRANDLIGHT_GBUFFER_VERTEX_PULL_GLSL
#define STRANDLIGHT_GBUFFER_VERTEX_PULL_GLSL

#include "shared/octahedral.h"

vec3 unpackDirection(uint word)
{
    return octDecode(unpackSnorm2x16(word) * 0.5 + 0.5);
}

// Second texture coordinates of a triangle follow all first ones.
vec2 secondTexCoord(uint slot, uint corner, uint triangleCount)
{
    uvec4 words = imageLoad(SCENE_CORNERS, int(3u * triangleCount + 2u * slot + corner / 2u));
    return uintBitsToFloat((corner & 1u) == 0u ? words.xy : words.zw);
}

#endif
