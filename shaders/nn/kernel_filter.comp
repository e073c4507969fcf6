// A 3x3 kernel predicted for each pixel, forward and backward to its logits (reference/kernel_filter.hpp).
// Bako et al. Kernel-Predicting Convolutional Networks for Denoising Monte Carlo Renderings. 2017
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"
#include "nn/divide.glsl"
#include "nn/nn_math.glsl"

layout(local_size_x = 32) in;
layout(constant_id = 0) const uint BACKWARD = 0; // 0: result = y. 1: result = dLogits

layout(binding = 0, r32f) uniform readonly imageBuffer logits; // [N,9,H,W]
layout(binding = 1, r32f) uniform readonly imageBuffer image;  // [N,4,H,W]
layout(binding = 2, r32f) uniform readonly imageBuffer dY;     // [N,4,H,W]; BACKWARD
layout(binding = 3, scalar) writeonly buffer Result { float result[]; };
layout(push_constant, scalar) uniform Push { KernelFilterPush push; };

const int T = int(kFilterTaps);
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

    // Softmax over the taps inside; the largest logit is subtracted so that no exponential overflows.
    int logitAt = int(push.logits.offset + n * push.logits.imageStride + pixel);
    float weight[T];
    bool inside[T];
    int tap[T];
    float largest = uintBitsToFloat(0xff800000u);
    [[unroll]] for (int k = 0; k < T; ++k) {
        int ty = y + k / 3 - 1;
        int tx = x + k % 3 - 1;
        inside[k] = uint(ty) < push.image.height && uint(tx) < push.image.width;
        tap[k] = inside[k] ? ty * int(push.image.width) + tx : 0;
        weight[k] = imageLoad(logits, logitAt + k * int(plane)).x;
        largest = inside[k] && !(weight[k] <= largest) ? weight[k] : largest; // NaN is taken and spreads
    }
    float sum = 0.0;
    [[unroll]] for (int k = 0; k < T; ++k) {
        weight[k] = inside[k] ? nnExp(weight[k] - largest) : 0.0;
        sum += weight[k];
    }
    [[unroll]] for (int k = 0; k < T; ++k)
        weight[k] /= sum;

    int imageAt = int(push.image.offset + n * push.image.imageStride);
    uint resultAt = push.result.offset + n * push.result.imageStride + pixel;
    if (BACKWARD == 0u) {
        [[unroll]] for (int c = 0; c < C; ++c) {
            float value = 0.0;
            [[unroll]] for (int k = 0; k < T; ++k)
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
    [[unroll]] for (int k = 0; k < T; ++k) {
        g[k] = 0.0;
        [[unroll]] for (int c = 0; c < C; ++c)
            g[k] += along[c] * imageLoad(image, imageAt + c * int(plane) + tap[k]).x;
        mean += weight[k] * g[k];
    }
    [[unroll]] for (int k = 0; k < T; ++k)
        result[resultAt + uint(k) * plane] = weight[k] * (g[k] - mean);
}
