// Share of the lights that arrives at the hair, mean of four samples, 0 where there is none; added to a sum over frames.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DMS features; // brightness, illumination, transparency, depth
layout(binding = 1, r32f) uniform image2D illumination;
layout(push_constant, scalar) uniform Push { HairResolvePush push; };

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    float sum = 0.0;
    for (int s = 0; s < 4; ++s) {
        sum += texelFetch(features, pixel, s).y;
    }
    imageStore(illumination, pixel, imageLoad(illumination, pixel) + 0.25 * push.weight * sum);
}
