// Sum of many floats, both stages: an invocation adds its quads in memory order, compensated, and the second stage is
// one invocation over the results of the first.
// Kahan. Further Remarks on Reducing Truncation Errors. 1965
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) uniform readonly imageBuffer quads;
layout(binding = 1, scalar) writeonly buffer Result { float result[]; };
layout(push_constant, scalar) uniform Push { SumPush push; };

void main()
{
    uint id = gl_GlobalInvocationID.x;
    if (id >= push.invocations)
        return;
    // Eight neighbours read eight neighbouring quads, then the next eight: each group streams through its own stretch.
    uint lanes = min(push.invocations, 8u);
    uint quad = id / lanes * lanes * push.turns + id % lanes;
    precise vec4 sum = vec4(0.0);
    precise vec4 lost = vec4(0.0); // what `sum` has too much
    for (uint turn = 0; turn < push.turns; ++turn) {
        uvec4 element = uvec4(0, 1, 2, 3) + quad * 4;
        vec4 value = imageLoad(quads, int(quad));
        value = mix(vec4(0.0), value, lessThan(element, uvec4(push.count))); // behind the last one anything may lie
        precise vec4 term = value - lost;
        precise vec4 total = sum + term;
        lost = (total - sum) - term;
        sum = total;
        quad += lanes;
    }
    precise float half0 = sum.x + sum.y, half1 = sum.z + sum.w;
    precise float excess = ((half0 - sum.x) - sum.y) + ((half1 - sum.z) - sum.w);
    precise float both = half0 + half1;
    excess += ((both - half0) - half1) + ((lost.x + lost.y) + (lost.z + lost.w));
    result[id] = (both - excess) * push.scale;
}
