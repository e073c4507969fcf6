// Mean of factor x factor pixels in linear radiance: the box filter that the path tracer's pixels have.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/shade_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image2D source;
layout(binding = 1, rgba32f) uniform writeonly image2D result;
layout(push_constant, scalar) uniform Push { DownsamplePush push; };

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    int factor = int(push.factor);
    vec3 sum = vec3(0.0);
    for (int y = 0; y < factor; ++y) {
        for (int x = 0; x < factor; ++x) {
            sum += imageLoad(source, pixel * factor + ivec2(x, y)).rgb;
        }
    }
    imageStore(result, pixel, vec4(sum / float(factor * factor), 1.0));
}
