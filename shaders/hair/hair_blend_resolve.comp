// The blended sums as premultiplied radiance: their means, as far as the exact transmittance lets hair show.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D near;  // radiance times weight, weight
layout(binding = 1) uniform sampler2D deep;  // brightness times weight, weight
layout(binding = 2) uniform sampler2D exact; // transmittance
layout(binding = 3, rgba32f) uniform writeonly image2D blended; // premultiplied radiance, deep brightness
layout(push_constant, scalar) uniform Push { HairResolvePush push; };

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    vec4 front = texelFetch(near, pixel, 0);
    vec2 all = texelFetch(deep, pixel, 0).xy;
    vec4 mean = vec4(front.a > 0.0 ? front.rgb / front.a : vec3(0.0), all.y > 0.0 ? all.x / all.y : 0.0);
    imageStore(blended, pixel, mean * (1.0 - texelFetch(exact, pixel, 0).x));
}
