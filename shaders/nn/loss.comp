// Loss, first stage: value of one chunk of elements, and the gradient of each element (reference/loss.hpp).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"
#include "nn/nn_math.glsl"

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint KIND = 0; // LossKind
layout(constant_id = 1) const uint WEIGHTED = 0;

layout(binding = 0, r32f) uniform readonly imageBuffer prediction;
layout(binding = 1, r32f) uniform readonly imageBuffer target;
layout(binding = 2, r32f) uniform readonly imageBuffer weights;
layout(binding = 3, scalar) writeonly buffer Gradient { float gradient[]; }; // overwritten
layout(binding = 4, scalar) writeonly buffer Chunks { float chunks[]; };
layout(push_constant, scalar) uniform Push { LossPush push; };

void main()
{
    uint chunk = gl_GlobalInvocationID.x;
    uint i = chunk * push.chunk;
    if (i >= push.count)
        return;
    uint end = min(i + push.chunk, push.count);
    uint among = push.firstChunk * push.chunk + i;
    uint inStride = among % push.weightStride;
    uint weightIndex = among / push.weightStride % push.weightCount;
    // Kahan's sum: `precise`, or the compiler proves the correction to be zero.
    precise float sum = 0.0;
    precise float lost = 0.0;
    for (; i < end; ++i) {
        float p = imageLoad(prediction, int(i)).x;
        float t = imageLoad(target, int(i)).x;
        float difference = p - t;
        float value = difference * difference;
        float derivative = 2.0 * difference;
        if (KIND == 1u) {
            if (abs(p) > 1e15) { // its square would overflow, and the floor is nothing beside it
                float ratio = difference / p;
                value = ratio * ratio;
                derivative = 2.0 * ratio / p;
            } else {
                float weight = 1.0 / (p * p + kRelativeLossFloor);
                value *= weight;
                derivative *= weight;
            }
        } else if (KIND == 2u) {
            float q = nnPositive(p);
            float distance = nnLog1p(q) - nnLog1p(nnPositive(t));
            value = distance * distance;
            derivative = 2.0 * distance / (1.0 + q);
        }
        if (WEIGHTED != 0u) {
            float weight = imageLoad(weights, int(weightIndex)).x;
            value *= weight;
            derivative *= weight;
            inStride += 1;
            bool next = inStride == push.weightStride;
            inStride = next ? 0 : inStride;
            weightIndex += next ? 1 : 0;
            weightIndex = weightIndex == push.weightCount ? 0 : weightIndex;
        }
        gradient[i] = derivative * push.scale;
        precise float term = value - lost;
        precise float total = sum + term;
        lost = (total - sum) - term;
        sum = total;
    }
    chunks[push.firstChunk + chunk] = sum;
}
