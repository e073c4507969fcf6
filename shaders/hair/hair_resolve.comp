// Plain average of the samples, added to a sum over frames: hair with its transmittance, and what shows beside it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DMS color; // radiance, above 0 where hair
layout(binding = 1, rgba32f) uniform image2D hair;
layout(binding = 2, rgba32f) uniform image2D behind;
layout(push_constant, scalar) uniform Push { HairResolvePush push; };

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    vec4 covered = vec4(0.0);
    vec4 open = vec4(0.0);
    for (int s = 0; s < int(push.samples); ++s) {
        vec4 value = texelFetch(color, pixel, s);
        float strand = value.a > 0.0 ? 1.0 : 0.0; // alpha to coverage leaves the strand's alpha
        covered.rgb += value.rgb * strand;
        open += vec4(value.rgb, 1.0) * (1.0 - strand);
    }
    float weight = push.weight / float(push.samples);
    imageStore(hair, pixel, imageLoad(hair, pixel) + weight * vec4(covered.rgb, open.w));
    imageStore(behind, pixel, imageLoad(behind, pixel) + weight * open);
}
