// Bias gradient, first stage: strip[s][c] = sum over the strip's pixels of tensor[n,c,y,x].
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"

layout(local_size_x = 8, local_size_y = 4) in;
layout(binding = 0, r32f) uniform readonly imageBuffer tensor; // [N,C,H,W]
layout(binding = 1, scalar) writeonly buffer Strips { float strips[]; };
layout(push_constant, scalar) uniform Push { ChannelSumPush push; };

void main()
{
    uint strip = gl_GlobalInvocationID.x;
    uint channel = gl_GlobalInvocationID.y;
    uint pixel = strip * push.stripPixels;
    if (pixel >= push.pixels || channel >= push.channels)
        return;
    uint end = min(pixel + push.stripPixels, push.pixels);
    uint plane = push.tensor.height * push.tensor.width;
    uint n = pixel / plane;
    uint inPlane = pixel - n * plane;
    uint address = push.tensor.offset + n * push.tensor.imageStride + channel * plane + inPlane;
    // Kahan's sum: `precise`, or the compiler proves the correction to be zero.
    precise float sum = 0.0;
    precise float lost = 0.0;
    for (; pixel < end; ++pixel) {
        precise float term = imageLoad(tensor, int(address)).x - lost;
        precise float total = sum + term;
        lost = (total - sum) - term;
        sum = total;
        inPlane += 1;
        bool newImage = inPlane == plane;
        inPlane = newImage ? 0 : inPlane;
        address += newImage ? push.tensor.imageStride - plane + 1 : 1;
    }
    strips[strip * push.channels + channel] = sum;
}
