// Weight gradient of a convolution, first stage: each invocation sums one strip of pixels.
//   strip[s][a,b,ky,kx] = sum over the strip's pixels of small[n,a,y,x] large[n,b, y sh - ph + ky, x sw - pw + kx]
// Convolution: small = dY, large = x, a = output, b = input channel. Transposed: small = x, large = dY, a = input, b = output.
//
// Lanes are channels a; an invocation keeps A x B sums, B consecutive columns (b,ky,kx). The lanes load eight different
// columns at once and hand them round by shuffles. The second stage (strip_sum.comp) adds the strips in order: no atomics,
// so the result is bitwise repeatable.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#include "shared/nn_types.h"

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint A = 2;  // vectors of eight channels a
layout(constant_id = 1) const uint B = 32; // columns, a multiple of 8
layout(constant_id = 2) const uint U = 2;  // pixels per loop turn
layout(constant_id = 3) const uint FLAGS = 0;

layout(binding = 0, r32f) uniform readonly imageBuffer smallTensor;
layout(binding = 1, r32f) uniform readonly imageBuffer largeTensor;
layout(binding = 2, scalar) writeonly buffer Strips { float strips[]; }; // [strip][a,b,ky,kx]
layout(push_constant, scalar) uniform Push { ConvWeightPush push; };

const uint kLanes = 8;
const uint V = B / kLanes;

void main()
{
    uint strip = push.firstStrip + gl_WorkGroupID.z;
    uint firstColumn = gl_WorkGroupID.x * B;
    uint firstA = gl_WorkGroupID.y * A * kLanes;
    uint lane = gl_LocalInvocationID.x;
    uint taps = push.kernelHeight * push.kernelWidth;
    uint columns = push.largeChannels * taps;
    int largePlane = int(push.large.height * push.large.width);
    int smallPlane = int(push.small.height * push.small.width);

    // The columns this lane loads for all eight.
    int columnY[V], columnX[V], columnAddress[V];
    [[unroll]] for (uint v = 0; v < V; ++v) {
        uint column = min(firstColumn + v * kLanes + lane, columns - 1);
        uint b = column / taps;
        uint tap = column - b * taps;
        columnY[v] = int(tap / push.kernelWidth) - int(push.paddingHeight);
        columnX[v] = int(tap % push.kernelWidth) - int(push.paddingWidth);
        columnAddress[v] = int(push.large.offset) + int(b) * largePlane;
    }
    int channelAddress[A];
    [[unroll]] for (uint a = 0; a < A; ++a)
        channelAddress[a] = int(push.small.offset) + int(min(firstA + a * kLanes + lane, push.smallChannels - 1)) * smallPlane;

    float sum[A][B];
    [[unroll]] for (uint a = 0; a < A; ++a)
        [[unroll]] for (uint b = 0; b < B; ++b)
            sum[a][b] = 0.0;

    uint pixel = strip * push.stripLength;
    uint end = min(pixel + push.stripLength, push.pixels);
    uint n = pixel / uint(smallPlane);
    int inPlane = int(pixel - n * uint(smallPlane));
    int y = inPlane / int(push.small.width);
    int x = inPlane - y * int(push.small.width);
    int smallImage = int(n * push.small.imageStride);
    int largeImage = int(n * push.large.imageStride);

    for (; pixel < end; pixel += U) {
        [[unroll]] for (uint u = 0; u < U; ++u) {
            bool live = pixel + u < end;
            float left[A];
            [[unroll]] for (uint a = 0; a < A; ++a) {
                float loaded = imageLoad(smallTensor, live ? channelAddress[a] + smallImage + inPlane : int(push.small.offset)).x;
                left[a] = live ? loaded : 0.0;
            }
            [[unroll]] for (uint v = 0; v < V; ++v) {
                int iy = y * int(push.strideHeight) + columnY[v];
                int ix = x * int(push.strideWidth) + columnX[v];
                bool readable = live && uint(iy) < push.large.height && uint(ix) < push.large.width;
                int address = columnAddress[v] + largeImage + iy * int(push.large.width) + ix;
                float loaded = imageLoad(largeTensor, readable ? address : int(push.large.offset)).x;
                float right = readable ? loaded : 0.0;
                if ((FLAGS & kConvShuffle) != 0) {
                    [[unroll]] for (uint k = 0; k < kLanes; ++k) {
                        float value = subgroupShuffle(right, k);
                        [[unroll]] for (uint a = 0; a < A; ++a)
                            sum[a][v * kLanes + k] += left[a] * value;
                    }
                } else {
                    [[unroll]] for (uint k = 0; k < kLanes; ++k) {
                        // Without shuffles every lane computes the address of lane k for itself.
                        uint column = min(firstColumn + v * kLanes + k, columns - 1);
                        uint tap = column % taps;
                        int ky = y * int(push.strideHeight) + int(tap / push.kernelWidth) - int(push.paddingHeight);
                        int kx = x * int(push.strideWidth) + int(tap % push.kernelWidth) - int(push.paddingWidth);
                        bool there = live && uint(ky) < push.large.height && uint(kx) < push.large.width;
                        int from = int(push.large.offset) + int(column / taps) * largePlane + largeImage +
                                   ky * int(push.large.width) + kx;
                        float got = imageLoad(largeTensor, there ? from : int(push.large.offset)).x;
                        float value = there ? got : 0.0;
                        [[unroll]] for (uint a = 0; a < A; ++a)
                            sum[a][v * kLanes + k] += left[a] * value;
                    }
                }
            }
            // Next pixel, by counting: integer division has no vector form on a CPU.
            x += 1;
            inPlane += 1;
            bool newRow = x == int(push.small.width);
            x = newRow ? 0 : x;
            y += newRow ? 1 : 0;
            bool newImage = inPlane == smallPlane;
            y = newImage ? 0 : y;
            inPlane = newImage ? 0 : inPlane;
            smallImage += newImage ? int(push.small.imageStride) : 0;
            largeImage += newImage ? int(push.large.imageStride) : 0;
        }
    }

    uint stripOffset = strip * push.stripStride;
    [[unroll]] for (uint a = 0; a < A; ++a) {
        uint channel = firstA + a * kLanes + lane;
        [[unroll]] for (uint b = 0; b < B; ++b)
            if (channel < push.smallChannels && firstColumn + b < columns)
                strips[stripOffset + channel * columns + firstColumn + b] = sum[a][b];
    }
}
