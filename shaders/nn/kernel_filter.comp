// A 3x3 kernel predicted for each pixel, forward and backward to its logits (reference/kernel_filter.hpp).
// Bako et al. Kernel-Predicting Convolutional Networks for Denoising Monte Carlo Renderings. 2017
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"
#include "nn/divide.glsl"
#include "nn/filter_weights.glsl"

layout(local_size_x = 32) in;
layout(constant_id = 0) const uint BACKWARD = 0; // 0: result = y. 1: result = dLogits

layout(binding = 0, r32f) uniform readonly imageBuffer logits; // [N,9,H,W]
layout(binding = 1, r32f) uniform readonly imageBuffer image;  // [N,4,H,W]
layout(binding = 2, r32f) uniform readonly imageBuffer dY;     // [N,4,H,W]; BACKWARD
layout(binding = 3, scalar) writeonly buffer Result { float result[]; };
layout(push_constant, scalar) uniform Push { KernelFilterPush push; };

const uint T = kFilterTaps;
const int C = int(kFilterChannels);

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    uint n = gl_GlobalInvocationID.y;
    uint plane = push.image.height * push.image.width;
    if (pixel >= plane)
        return;
    int y = int(divide(pixel, push.image.width));
    int x = int(pixel) - y * int(push.image.width);

    int logitAt = int(push.logits.offset + n * push.logits.imageStride + pixel);
    float weight[T];
    bool inside[T];
    int tap[T];
    [[unroll]] for (int k = 0; k < int(T); ++k) {
        int ty = y + k / 3 - 1;
        int tx = x + k % 3 - 1;
        inside[k] = uint(ty) < push.image.height && uint(tx) < push.image.width;
        tap[k] = inside[k] ? ty * int(push.image.width) + tx : 0;
        weight[k] = imageLoad(logits, logitAt + k * int(plane)).x;
    }
    filterWeights(weight, inside);

    int imageAt = int(push.image.offset + n * push.image.imageStride);
    uint resultAt = push.result.offset + n * push.result.imageStride + pixel;
    if (BACKWARD == 0u) {
        [[unroll]] for (int c = 0; c < C; ++c) {
            float value = 0.0;
            [[unroll]] for (int k = 0; k < int(T); ++k)
                value += weight[k] * imageLoad(image, imageAt + c * int(plane) + tap[k]).x;
            result[resultAt + uint(c) * plane] = value;
        }
        return;
    }
    float along[C];
    [[unroll]] for (int c = 0; c < C; ++c)
        along[c] = imageLoad(dY, int(push.dY.offset + n * push.dY.imageStride + pixel) + c * int(plane)).x;
    float g[T];
    float mean = 0.0;
    [[unroll]] for (int k = 0; k < int(T); ++k) {
        g[k] = 0.0;
        [[unroll]] for (int c = 0; c < C; ++c)
            g[k] += along[c] * imageLoad(image, imageAt + c * int(plane) + tap[k]).x;
        mean += weight[k] * g[k];
    }
    [[unroll]] for (int k = 0; k < int(T); ++k)
        result[resultAt + uint(k) * plane] = weight[k] * (g[k] - mean);
}
