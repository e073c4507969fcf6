// What is behind the hair: the mean of the samples before strands were drawn.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DMS color;
layout(binding = 1, rgba32f) uniform writeonly image2D radiance;
layout(push_constant, scalar) uniform Push { HairResolvePush push; };

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    vec3 sum = vec3(0.0);
    for (int s = 0; s < 4; ++s) {
        sum += texelFetch(color, pixel, s).rgb;
    }
    imageStore(radiance, pixel, vec4(0.25 * sum, 1.0));
}
