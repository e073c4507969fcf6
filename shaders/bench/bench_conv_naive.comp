// A convolution as one writes it first: one invocation an output, every tap tested against the image's edge.
// What the engine's kernel is compared with.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/bench_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, scalar) readonly buffer Source { float source[]; };   // [I,H,W]
layout(binding = 1, scalar) readonly buffer Weights { float weights[]; }; // [O,I,K,K], then the bias [O]
layout(binding = 2, scalar) writeonly buffer Result { float result[]; };  // [O,H,W]
layout(push_constant, scalar) uniform Push { BenchConvPush push; };

void main()
{
    int width = int(push.width), height = int(push.height), taps = int(push.kernel);
    int x = int(gl_GlobalInvocationID.x), y = int(gl_GlobalInvocationID.y), o = int(gl_GlobalInvocationID.z);
    if (x >= width || y >= height)
        return;
    int inputs = int(push.inChannels);
    float sum = weights[int(push.outChannels) * inputs * taps * taps + o];
    for (int i = 0; i < inputs; ++i)
        for (int ky = 0; ky < taps; ++ky)
            for (int kx = 0; kx < taps; ++kx) {
                int sy = y + ky - int(push.padding), sx = x + kx - int(push.padding);
                if (sy >= 0 && sx >= 0 && sy < height && sx < width)
                    sum += source[(i * height + sy) * width + sx] * weights[((o * inputs + i) * taps + ky) * taps + kx];
            }
    result[(o * height + y) * width + x] = max(sum, 0.0);
}
