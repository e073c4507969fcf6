// Adds strips in their order, groups of them at a time: result[g][i] = sum over the group's strips of strip[s][i]; the last
// stage has one group and adds to what the result holds.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"

layout(local_size_x = 32) in;
layout(binding = 0, rgba32f) uniform readonly imageBuffer strips; // [strip][stride], in quads
layout(binding = 1, scalar) buffer Result { float result[]; };
layout(push_constant, scalar) uniform Push { ReducePush push; };

void main()
{
    uint quad = gl_GlobalInvocationID.x;
    uint group = gl_GlobalInvocationID.y;
    uint stride = push.stride / 4;
    if (quad >= stride)
        return;
    // Kahan's sum: `precise`, or the compiler proves the correction to be zero.
    precise vec4 sum = vec4(0.0);
    precise vec4 lost = vec4(0.0);
    uint end = min((group + 1) * push.groupStrips, push.strips);
    for (uint s = group * push.groupStrips; s < end; ++s) {
        precise vec4 term = imageLoad(strips, int(s * stride + quad)) - lost;
        precise vec4 total = sum + term;
        lost = (total - sum) - term;
        sum = total;
    }
    uint at = push.resultOffset + group * push.stride + 4 * quad;
    [[unroll]] for (uint i = 0; i < 4; ++i)
        if (4 * quad + i < push.count)
            result[at + i] = push.accumulate != 0 ? result[at + i] + sum[i] : sum[i];
}
