// Loss, second stage: one invocation adds the chunks in order and scales; result[0] is the loss.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"

layout(local_size_x = 1) in;
layout(binding = 0, r32f) uniform readonly imageBuffer chunks;
layout(binding = 1, scalar) writeonly buffer Result { float result[]; };
layout(push_constant, scalar) uniform Push { LossPush push; };

void main()
{
    uint count = (push.count + push.chunk - 1) / push.chunk;
    precise float sum = 0.0;
    precise float lost = 0.0;
    for (uint i = 0; i < count; ++i) {
        precise float term = imageLoad(chunks, int(i)).x - lost;
        precise float total = sum + term;
        lost = (total - sum) - term;
        sum = total;
    }
    result[0] = sum * push.scale;
}
