// A picture to see that the graph runs: red grows with x, green with y, both scaled by `gain`.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/sample_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) writeonly uniform image2D outputImage;
layout(push_constant, scalar) uniform Push { GradientPush push; };

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= push.width || pixel.y >= push.height)
        return;
    vec2 position = (vec2(pixel) + 0.5) / vec2(push.width, push.height);
    imageStore(outputImage, ivec2(pixel), vec4(position * push.gain, 0.25, 1.0));
}
