// radiance[n,d] = sum over lobes of amplitude exp(-sharpness/2 |d - axis|^2).
// A lane is an image: its lobes stay with it, directions come by, nothing crosses lanes. Four directions at once make the
// stores whole vectors, which a CPU device writes four times faster than single floats; with RESULT_WIDE eight come by,
// stored at once (wide_store.glsl).
// VARIANT wide RESULT_WIDE
// Wang et al. All-Frequency Rendering of Dynamic, Spatially-Varying Reflectance. 2009
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#ifdef RESULT_WIDE
#include "nn/wide_store.glsl"
#endif

#include "nn/sg_lobe.glsl"

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint LOBES = 1;  // of one block, in registers
layout(constant_id = 1) const uint BLOCKS = 1; // of an image
layout(constant_id = 2) const uint TILE = 1;   // 4, wide 8: planar radiance, directions a multiple of that; else 1
layout(binding = 0, r32f) uniform readonly imageBuffer lobes;      // [N,L,7] decoded
layout(binding = 1, r32f) uniform readonly imageBuffer directions; // [N,D,3] or [D,3], unit
layout(binding = 2, rgba32f) uniform readonly imageBuffer directionQuads;
layout(binding = 3, scalar) writeonly buffer Radiance { float radiance[]; };
#ifdef RESULT_WIDE
layout(binding = 4, scalar) writeonly buffer RadianceOctets { u64vec4 radianceOctets[]; };
#else
layout(binding = 4, scalar) writeonly buffer RadianceQuads { vec4 radianceQuads[]; };
#endif
layout(binding = 5, rgba32f) uniform readonly imageBuffer lobeQuads;
layout(push_constant, scalar) uniform Push { SgMixturePush push; };

#include "nn/sg_directions.glsl"
#include "nn/sg_load_lobes.glsl"

vec3 axis[LOBES];
float falloff[LOBES]; // -sharpness/2, for powers of two
vec3 amplitude[LOBES];
vec3 sum[TILE];

void loadLobes(uint first)
{
    loadLobeValues(first);
    [[unroll]] for (uint l = 0; l < LOBES; ++l) {
        axis[l] = vec3(lobeValues[7 * l], lobeValues[7 * l + 1], lobeValues[7 * l + 2]);
        falloff[l] = -0.5 * kLog2E * lobeValues[7 * l + 3];
        amplitude[l] = vec3(lobeValues[7 * l + 4], lobeValues[7 * l + 5], lobeValues[7 * l + 6]);
    }
}

void store(uint n, uint first)
{
    uint to = n * 3 * push.directions + first * push.directionStride;
    [[unroll]] for (uint c = 0; c < 3; ++c) {
#ifdef RESULT_WIDE
        radianceOctets[(to + c * push.channelStride) / 8] =
            asPairs(vec4(sum[0][c], sum[1 % TILE][c], sum[2 % TILE][c], sum[3 % TILE][c]),
                    vec4(sum[4 % TILE][c], sum[5 % TILE][c], sum[6 % TILE][c], sum[7 % TILE][c]));
#else
        if (TILE == 4)
            radianceQuads[(to + c * push.channelStride) / 4] =
                vec4(sum[0][c], sum[1 % TILE][c], sum[2 % TILE][c], sum[3 % TILE][c]);
        else
            radiance[to + c * push.channelStride] = sum[0][c];
#endif
    }
}

void main()
{
    uint n = push.firstImage + gl_GlobalInvocationID.x;
    if (n >= push.images)
        return;
    if (BLOCKS == 1)
        loadLobes(n * push.lobes);
    uint begin = gl_GlobalInvocationID.y * kSgMixtureSlice;
    uint end = min(begin + kSgMixtureSlice, push.directions);
    for (uint first = begin; first < end; first += TILE) {
        loadDirections(n, first);
        [[unroll]] for (uint j = 0; j < TILE; ++j)
            sum[j] = vec3(0.0);
        for (uint block = 0; block < BLOCKS; ++block) {
            if (BLOCKS > 1)
                loadLobes(n * push.lobes + block * LOBES);
            [[unroll]] for (uint l = 0; l < LOBES; ++l)
                [[unroll]] for (uint j = 0; j < TILE; j += OF_FOUR) {
                    vec4 lobe = nnExp2Negative(falloff[l] * chordsTo(axis[l], j).squared);
                    [[unroll]] for (uint i = 0; i < OF_FOUR; ++i)
                        sum[j + i] += amplitude[l] * lobe[i];
                }
        }
        store(n, first);
    }
}
