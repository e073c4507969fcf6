// Counts values that are NaN, infinite or beyond the limit. Compares bits: comparisons of NaN and clamps are not to be
// relied on in a shader. The counter is an integer, so the order of the atomic additions does not matter.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"

layout(local_size_x = 32) in;
layout(constant_id = 0) const uint QUAD = 4; // values of a texel: 4 where they begin and end with whole ones, or 1
layout(binding = 0, r32ui) uniform readonly uimageBuffer tensor;
layout(binding = 1, rgba32ui) uniform readonly uimageBuffer tensorQuads;
layout(binding = 2, scalar) buffer Status { uint status[]; };
layout(push_constant, scalar) uniform Push { FiniteCheckPush push; };

void main()
{
    uint limit = floatBitsToUint(push.limit);
    uvec4 refused = uvec4(0);
    // Neighbours read neighbouring texels.
    for (uint i = gl_GlobalInvocationID.x; i < push.texels; i += push.invocations) {
        int at = int(push.firstTexel + i);
        uvec4 values = QUAD == 4 ? imageLoad(tensorQuads, at) : uvec4(imageLoad(tensor, at).x, 0, 0, 0);
        refused += uvec4(greaterThan(values & 0x7fffffffu, uvec4(limit)));
    }
    uint count = (refused.x + refused.y) + (refused.z + refused.w);
    if (count != 0)
        atomicAdd(status[push.slot], count);
}
