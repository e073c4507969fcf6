// Bias gradient, first stage: each invocation sums every `invocations`-th texel of a channel into strip[s][c].
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"
#include "nn/divide.glsl"

layout(local_size_x = 32) in;
layout(constant_id = 0) const uint QUAD = 4; // floats of a texel: 4 where planes are whole quads, or 1
layout(binding = 0, r32f) uniform readonly imageBuffer tensor; // [N,C,H,W]
layout(binding = 1, rgba32f) uniform readonly imageBuffer tensorQuads;
layout(binding = 2, scalar) writeonly buffer Strips { float strips[]; };
layout(push_constant, scalar) uniform Push { ChannelSumPush push; };

void main()
{
    uint strip = gl_GlobalInvocationID.x; // neighbours read neighbouring texels
    uint channel = gl_GlobalInvocationID.y;
    uint plane = push.tensor.height * push.tensor.width / QUAD; // in texels, as all that follows
    uint imageStride = push.tensor.imageStride / QUAD;
    uint first = push.tensor.offset / QUAD + channel * plane;
    uint texels = push.images * plane;
    // Kahan's sum: `precise`, or the compiler proves the correction to be zero.
    precise vec4 sum = vec4(0.0);
    precise vec4 lost = vec4(0.0);
    for (uint i = strip; i < texels; i += push.invocations) {
        uint n = divide(i, plane);
        int at = int(first + n * imageStride + i - n * plane);
        precise vec4 value = QUAD == 4 ? imageLoad(tensorQuads, at) : vec4(imageLoad(tensor, at).x, 0.0, 0.0, 0.0);
        precise vec4 term = value - lost;
        precise vec4 total = sum + term;
        lost = (total - sum) - term;
        sum = total;
    }
    if (strip < push.invocations)
        strips[strip * push.stripStride + channel] = (sum.x + sum.y) + (sum.z + sum.w);
}
