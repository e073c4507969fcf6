// Second stage of a gradient: result[i] += sum over strips of strip[s][i], in the order of the strips.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"

layout(local_size_x = 32) in;
layout(binding = 0, r32f) uniform readonly imageBuffer strips;
layout(binding = 1, scalar) buffer Result { float result[]; };
layout(push_constant, scalar) uniform Push { ReducePush push; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count)
        return;
    // Kahan's sum: `precise`, or the compiler proves the correction to be zero.
    precise float sum = 0.0;
    precise float lost = 0.0;
    for (uint s = 0; s < push.strips; ++s) {
        precise float term = imageLoad(strips, int(s * push.count + i)).x - lost;
        precise float total = sum + term;
        lost = (total - sum) - term;
        sum = total;
    }
    result[push.resultOffset + i] += sum;
}
