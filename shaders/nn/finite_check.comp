// Counts values that are NaN, infinite or beyond the limit. Compares bits: comparisons of NaN and clamps are not to be
// relied on in a shader. The counter is an integer, so the order of the atomic additions does not matter.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"

layout(local_size_x = 32) in;
layout(binding = 0, r32ui) uniform readonly uimageBuffer tensor;
layout(binding = 1, scalar) buffer Status { uint status[]; };
layout(push_constant, scalar) uniform Push { FiniteCheckPush push; };

void main()
{
    uint begin = gl_GlobalInvocationID.x * push.chunk;
    uint end = min(begin + push.chunk, push.count);
    uint limit = floatBitsToUint(push.limit);
    uint refused = 0;
    for (uint i = begin; i < end; ++i)
        refused += (imageLoad(tensor, int(push.offset + i)).x & 0x7fffffffu) > limit ? 1u : 0u;
    if (refused != 0)
        atomicAdd(status[push.slot], refused);
}
