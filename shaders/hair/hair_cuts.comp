// Where the slices of depth end, in which strands are blended: such that each shows about as much hair as the others.
// The samples of stochastic transparency are distributed as what is seen, so the quantiles of those of a pixel and its
// four neighbours say it; a wrong cut costs little, since the sums between the cuts are exact.
// Enderton, Sintorn, Shirley, Luebke. Stochastic Transparency. 2010 (visibility from samples)
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DMS features; // brightness, illumination, transparency, depth in metres
layout(binding = 1, rgba32f) uniform writeonly image2D first;
layout(binding = 2, rgba32f) uniform writeonly image2D second; // .zw are never cut
layout(push_constant, scalar) uniform Push { HairResolvePush push; };

const ivec2 kTaps[5] = ivec2[5](ivec2(0, 0), ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
const int kCount = 20;
const float kFar = 1e30;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    float depth[kCount];
    int count = 0; // of samples with hair
    [[unroll]] for (int i = 0; i < kCount; ++i) {
        ivec2 tap = clamp(pixel + kTaps[i / 4], ivec2(0), ivec2(push.width, push.height) - 1);
        vec4 value = texelFetch(features, tap, i % 4);
        bool hair = value.z < 0.5;
        depth[i] = hair ? value.w : kFar;
        count += hair ? 1 : 0;
    }
    // Sorted by exchanges of neighbours: no index depends on a value, so all stays in registers.
    [[unroll]] for (int turn = 0; turn < kCount; ++turn) {
        [[unroll]] for (int i = turn % 2; i + 1 < kCount; i += 2) {
            float nearer = min(depth[i], depth[i + 1]);
            depth[i + 1] = max(depth[i], depth[i + 1]);
            depth[i] = nearer;
        }
    }
    float cut[kHairSlices];
    [[unroll]] for (int k = 0; k < int(kHairSlices); ++k) {
        cut[k] = kFar;
        int rank = ((k + 1) * count + int(kHairSlices) / 2) / int(kHairSlices);
        [[unroll]] for (int i = 1; i < kCount; ++i) {
            cut[k] = i == rank && i < count ? 0.5 * (depth[i - 1] + depth[i]) : cut[k];
        }
    }
    imageStore(first, pixel, vec4(cut[0], cut[1], cut[2], cut[3]));
    imageStore(second, pixel, vec4(cut[4], cut[5], kFar, kFar));
}
