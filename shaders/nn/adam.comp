// One optimiser step over a block of parameters; does nothing when a check of this step refused a value.
// Kingma and Ba. Adam: A Method for Stochastic Optimization. 2015 (reference/adam.hpp)
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"

layout(local_size_x = 32) in;
layout(binding = 0, r32f) uniform readonly imageBuffer gradient;
// Read as texels and written as a buffer: the same memory, each element by one invocation.
layout(binding = 1, r32f) uniform readonly imageBuffer oldParameters;
layout(binding = 2, r32f) uniform readonly imageBuffer oldMoment1;
layout(binding = 3, r32f) uniform readonly imageBuffer oldMoment2;
layout(binding = 4, scalar) writeonly buffer Parameters { float parameters[]; };
layout(binding = 5, scalar) writeonly buffer Moment1 { float moment1[]; };
layout(binding = 6, scalar) writeonly buffer Moment2 { float moment2[]; };
layout(binding = 7, r32ui) uniform readonly uimageBuffer status;
layout(binding = 8, scalar) buffer Counters { uint counters[]; };
layout(push_constant, scalar) uniform Push { AdamPush push; };

// Elements of one invocation: the status is read once for all.
const uint P = 4;

void main()
{
    uint id = gl_GlobalInvocationID.x;
    uint refused = 0;
    [[unroll]] for (int slot = 0; slot < int(kStatusSlots); ++slot)
        refused |= imageLoad(status, slot).x;
    if (id == 0) {
        for (int slot = 0; slot < int(kStatusSlots); ++slot)
            counters[kCounterSlots + slot] += imageLoad(status, slot).x;
        counters[refused != 0 ? kCounterSkipped : kCounterTaken] += 1;
    }
    if (refused != 0)
        return;
    uint first = id / 8 * 8 * P + id % 8; // eight neighbours own eight neighbouring elements, P times
    [[unroll]] for (uint j = 0; j < P; ++j) {
        uint i = first + j * 8;
        if (i < push.count) {
            float g = imageLoad(gradient, int(i)).x;
            float m = push.beta1 * imageLoad(oldMoment1, int(i)).x + push.oneMinusBeta1 * g;
            float v = push.beta2 * imageLoad(oldMoment2, int(i)).x + push.oneMinusBeta2 * g * g;
            moment1[i] = m;
            moment2[i] = v;
            parameters[i] = imageLoad(oldParameters, int(i)).x -
                            push.stepSize * m / (sqrt(v) * push.inverseRootCorrection2 + push.epsilon);
        }
    }
}
