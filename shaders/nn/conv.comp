// Convolution and transposed convolution of any shape, and their data gradients: one gather.
// Dumoulin and Visin. A guide to convolution arithmetic for deep learning. 2016
//
// An invocation sums K output channels of P pixels in registers. Pixels are numbered through the whole batch, so small
// images fill the lanes as well as large ones. Of a transposed convolution, one workgroup layer z holds the pixels of one
// phase (y mod stride, x mod stride): they all read the same taps, and no lane multiplies by a structural zero.
//
// Loads go through texel buffers (one hardware gather on lavapipe, against a loop of eight for storage buffers). Weights
// are loaded by lane, eight channels at once, and handed round by shuffles; without kConvShuffle each is loaded by itself.
// VARIANT half SOURCE_HALF RESULT_HALF
// VARIANT from_half SOURCE_HALF
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#define GUARD_BINDING 4
#include "nn/elements.glsl"
#include "shared/nn_types.h"
#include "nn/divide.glsl"

layout(local_size_x = 32) in;
layout(constant_id = 0) const uint K = 16; // output channels of an invocation
layout(constant_id = 1) const uint P = 4;  // pixels of an invocation
layout(constant_id = 2) const uint U = 1;  // input channels per loop turn; divides their number
layout(constant_id = 3) const uint FLAGS = 0;

layout(binding = 0, SOURCE_TEXEL) uniform readonly imageBuffer inputTensor; // [N,C,H,W]
layout(binding = 1, r32f) uniform readonly imageBuffer parameters;  // weights and biases
layout(binding = 2, SOURCE_TEXEL) uniform readonly imageBuffer saved;       // kConvDerivative: the activated values
layout(binding = 3, scalar) buffer Result { RESULT_ELEMENT result[]; }; // [N,K',H',W']
layout(push_constant, scalar) uniform Push { ConvPush push; };

const uint kLanes = 8; // pixels that lie next to each other; also the lanes that share a weight load
const uint W = (K + kLanes - 1) / kLanes;

void main()
{
    // Which pixels: eight neighbouring invocations own eight neighbouring pixels, P times.
    uint phaseWidth = push.transposed != 0 ? push.strideWidth : 1;
    uint phaseHeight = push.transposed != 0 ? push.strideHeight : 1;
    uint gridWidth = (push.result.width + phaseWidth - 1) / phaseWidth;
    uint gridHeight = (push.result.height + phaseHeight - 1) / phaseHeight;
    uint phaseX = gl_WorkGroupID.z % phaseWidth;
    uint phaseY = gl_WorkGroupID.z / phaseWidth;

    // The taps of this phase: first, step, and the input row and column that tap (0,0) of pixel (0,0) reads.
    int firstTapY = push.transposed != 0 ? int((phaseY + push.paddingHeight) % phaseHeight) : 0;
    int firstTapX = push.transposed != 0 ? int((phaseX + push.paddingWidth) % phaseWidth) : 0;
    int originY = push.transposed != 0 ? int((phaseY + push.paddingHeight) / phaseHeight) : -int(push.paddingHeight);
    int originX = push.transposed != 0 ? int((phaseX + push.paddingWidth) / phaseWidth) : -int(push.paddingWidth);
    int pixelStepY = push.transposed != 0 ? 1 : int(push.strideHeight);
    int pixelStepX = push.transposed != 0 ? 1 : int(push.strideWidth);
    int direction = push.transposed != 0 ? -1 : 1;

    uint first = push.firstPixel + gl_GlobalInvocationID.x / kLanes * kLanes * P + gl_GlobalInvocationID.x % kLanes;
    int top[P], left[P], image[P];
    uint store[P], imageIndex[P];
    bool inside[P];
    [[unroll]] for (uint j = 0; j < P; ++j) {
        uint pixel = first + j * kLanes;
        uint row = divide(pixel, gridWidth);
        uint n = divide(row, gridHeight);
        uint x = (pixel - row * gridWidth) * phaseWidth + phaseX;
        uint y = (row - n * gridHeight) * phaseHeight + phaseY;
        inside[j] = pixel < push.endPixel && x < push.result.width && y < push.result.height;
        top[j] = int(row - n * gridHeight) * pixelStepY + originY;
        left[j] = int(pixel - row * gridWidth) * pixelStepX + originX;
        image[j] = int(push.source.offset + n * push.source.imageStride);
        imageIndex[j] = n;
        store[j] = n * push.result.imageStride + y * push.result.width + x;
    }

    // Which weights: the last block repeats the last channel rather than read past the end.
    uint firstChannel = gl_WorkGroupID.y * K;
    int weightBase[K];
    int laneWeightBase[W];
    [[unroll]] for (uint k = 0; k < K; ++k)
        weightBase[k] = int(push.weightOffset + min(firstChannel + k, push.outChannels - 1) * push.weightStrideOut);
    uint lane = gl_SubgroupInvocationID % kLanes;
    [[unroll]] for (uint w = 0; w < W; ++w)
        laneWeightBase[w] = int(push.weightOffset +
                                min(firstChannel + w * kLanes + lane, push.outChannels - 1) * push.weightStrideOut);

    float sum[K][P];
    [[unroll]] for (uint k = 0; k < K; ++k)
        [[unroll]] for (uint j = 0; j < P; ++j)
            sum[k][j] = 0.0;

    int plane = int(push.source.height * push.source.width);
    int stepY = 0;
    for (int ky = firstTapY; ky < int(push.kernelHeight); ky += int(phaseHeight), stepY += direction) {
        int stepX = 0;
        for (int kx = firstTapX; kx < int(push.kernelWidth); kx += int(phaseWidth), stepX += direction) {
            int address[P];
            bool readable[P];
            [[unroll]] for (uint j = 0; j < P; ++j) {
                int y = top[j] + stepY;
                int x = left[j] + stepX;
                readable[j] = inside[j] && uint(y) < push.source.height && uint(x) < push.source.width;
                address[j] = readable[j] ? image[j] + y * int(push.source.width) + x : int(push.source.offset);
            }
            int tap = ky * int(push.kernelWidth) + kx;
            for (uint c = 0; c < push.inChannels; c += U) {
                [[unroll]] for (uint u = 0; u < U; ++u) {
                    float value[P];
                    [[unroll]] for (uint j = 0; j < P; ++j) {
                        float loaded = imageLoad(inputTensor, address[j]).x;
                        value[j] = readable[j] ? loaded : 0.0; // a select, not a product: NaN must not leak in
                        address[j] += plane;
                    }
                    if ((FLAGS & kConvShuffle) != 0) {
                        [[unroll]] for (uint w = 0; w < W; ++w) {
                            float weights = imageLoad(parameters, laneWeightBase[w] + tap).x;
                            [[unroll]] for (uint k = 0; k < kLanes; ++k)
                                if (w * kLanes + k < K) {
                                    float weight = subgroupShuffle(weights, k);
                                    [[unroll]] for (uint j = 0; j < P; ++j)
                                        sum[w * kLanes + k][j] += weight * value[j];
                                }
                        }
                    } else {
                        [[unroll]] for (uint k = 0; k < K; ++k) {
                            float weight = imageLoad(parameters, weightBase[k] + tap).x;
                            [[unroll]] for (uint j = 0; j < P; ++j)
                                sum[k][j] += weight * value[j];
                        }
                    }
                    tap += int(push.weightStrideIn);
                }
            }
        }
    }

    uint resultPlane = push.result.height * push.result.width;
    [[unroll]] for (uint k = 0; k < K; ++k) {
        uint channel = firstChannel + k;
        float bias = 0.0;
        if ((FLAGS & kConvBias) != 0)
            bias = imageLoad(parameters, int(push.biasOffset + min(channel, push.outChannels - 1))).x;
        [[unroll]] for (uint j = 0; j < P; ++j) {
            if (inside[j] && channel < push.outChannels) {
                uint at = store[j] + channel * resultPlane;
                float value = sum[k][j] + bias;
                if ((FLAGS & kConvAccumulate) != 0)
                    value += float(result[push.result.offset + at]);
                if ((FLAGS & kConvDerivative) != 0) {
                    // The saved tensor has the result's planes but its own place in its own buffer.
                    uint n = imageIndex[j];
                    uint savedAt = push.savedOffset + n * push.savedImageStride + at - n * push.result.imageStride;
                    value = imageLoad(saved, int(savedAt)).x > 0.0 ? value : value * push.slope;
                } else {
                    value = value > 0.0 ? value : value * push.slope;
                }
                result[push.result.offset + at] = RESULT_ELEMENT(guarded(value));
            }
        }
    }
    reportLargest();
}
