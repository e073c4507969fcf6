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

// logits [N,9,H,W], and backward their gradient, as three groups of three planes.
layout(binding = 0, r32f) uniform readonly imageBuffer logits0;
layout(binding = 1, r32f) uniform readonly imageBuffer logits1;
layout(binding = 2, r32f) uniform readonly imageBuffer logits2;
layout(binding = 3, r32f) uniform readonly imageBuffer image; // [N,4,H,W]
layout(binding = 4, r32f) uniform readonly imageBuffer dY;    // [N,4,H,W]; BACKWARD
layout(binding = 5, scalar) writeonly buffer Result0 { float result0[]; };
layout(binding = 6, scalar) writeonly buffer Result1 { float result1[]; };
layout(binding = 7, scalar) writeonly buffer Result2 { float result2[]; };
layout(push_constant, scalar) uniform Push { KernelFilterPush push; };

const uint T = kFilterTaps;
const int C = int(kFilterChannels);

// Of plane k; `at` is the pixel's place in a plane of its image. k is a constant where this is called.
float loadLogit(uint k, uint n, uint at, uint plane)
{
    int from = int(push.logitOffset[k / kFilterGroup] + n * push.logitImageStride + k % kFilterGroup * plane + at);
    if (k < kFilterGroup)
        return imageLoad(logits0, from).x;
    if (k < 2u * kFilterGroup)
        return imageLoad(logits1, from).x;
    return imageLoad(logits2, from).x;
}

void storeGradient(uint k, uint n, uint at, uint plane, float value)
{
    uint to = push.resultOffset[k / kFilterGroup] + n * push.resultImageStride + k % kFilterGroup * plane + at;
    if (k < kFilterGroup)
        result0[to] = value;
    else if (k < 2u * kFilterGroup)
        result1[to] = value;
    else
        result2[to] = value;
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    uint n = gl_GlobalInvocationID.y;
    uint plane = push.image.height * push.image.width;
    if (pixel >= plane)
        return;
    int y = int(divide(pixel, push.image.width));
    int x = int(pixel) - y * int(push.image.width);

    float weight[T];
    bool inside[T];
    int tap[T];
    [[unroll]] for (int k = 0; k < int(T); ++k) {
        int ty = y + k / 3 - 1;
        int tx = x + k % 3 - 1;
        inside[k] = uint(ty) < push.image.height && uint(tx) < push.image.width;
        tap[k] = inside[k] ? ty * int(push.image.width) + tx : 0;
        weight[k] = loadLogit(uint(k), n, pixel, plane);
    }
    filterWeights(weight, inside);

    int imageAt = int(push.image.offset + n * push.image.imageStride);
    if (BACKWARD == 0u) {
        [[unroll]] for (int c = 0; c < C; ++c) {
            float value = 0.0;
            [[unroll]] for (int k = 0; k < int(T); ++k)
                value += weight[k] * imageLoad(image, imageAt + c * int(plane) + tap[k]).x;
            result0[push.resultOffset[0] + n * push.resultImageStride + uint(c) * plane + pixel] = value;
        }
        return;
    }
    float along[C];
    [[unroll]] for (int c = 0; c < C; ++c)
        along[c] = imageLoad(dY, int(push.dYOffset + n * push.dYImageStride + pixel) + c * int(plane)).x;
    float g[T];
    float mean = 0.0;
    [[unroll]] for (int k = 0; k < int(T); ++k) {
        g[k] = 0.0;
        [[unroll]] for (int c = 0; c < C; ++c)
            g[k] += along[c] * imageLoad(image, imageAt + c * int(plane) + tap[k]).x;
        mean += weight[k] * g[k];
    }
    [[unroll]] for (int k = 0; k < int(T); ++k)
        storeGradient(uint(k), n, pixel, plane, weight[k] * (g[k] - mean));
}
