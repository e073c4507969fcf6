// Counter-based random numbers: no state is kept, so results do not depend on order, slicing or threads.
// Jarzynski and Olano. Hash Functions for GPU Rendering. 2020 (pcg3d, pcg)
#ifndef STRANDLIGHT_SHARED_RNG_H
#define STRANDLIGHT_SHARED_RNG_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

STRANDLIGHT_FN uint hashPcg(uint value)
{
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Three independent 32-bit values for a counter of three words.
STRANDLIGHT_FN uvec3 hashPcg3(uvec3 counter)
{
    uvec3 v = counter * 1664525u + uvec3(1013904223u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> uvec3(16u));
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Uniform in [0, 1): 24 bits, so the result is exact in fp32 and never 1.
STRANDLIGHT_FN float uniformFloat(uint bits)
{
    return float(bits >> 8u) * (1.0f / 16777216.0f);
}

// Three uniforms in [0, 1) for (item, sample, dimension). Draw more by raising `dimension`.
STRANDLIGHT_FN vec3 uniform3(uint item, uint sampleIndex, uint dimension, uint seed)
{
    uvec3 h = hashPcg3(uvec3(item, sampleIndex, dimension ^ hashPcg(seed)));
    return vec3(uniformFloat(h.x), uniformFloat(h.y), uniformFloat(h.z));
}

STRANDLIGHT_SHARED_END

#endif
