// Exposure, clamp and the sRGB curve (IEC 61966-2-1). No film curve: pictures compare one to one with a reference.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/nan_bits.h"
#include "shared/shade_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image2D source;
layout(binding = 1, rgba8) uniform writeonly image2D result;
layout(push_constant, scalar) uniform Push { TonemapPush push; };

vec3 encodeSrgb(vec3 c)
{
    vec3 low = c * 12.92;
    vec3 high = 1.055 * pow(max(c, vec3(1e-8)), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(c, vec3(0.0031308)));
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    vec3 radiance = imageLoad(source, pixel).rgb * push.exposure;
    // A NaN shows as magenta instead of vanishing in the clamp.
    bool broken = isNanByBits(radiance.x) || isNanByBits(radiance.y) || isNanByBits(radiance.z);
    vec3 color = broken ? vec3(1.0, 0.0, 1.0) : encodeSrgb(clamp(radiance, 0.0, 1.0));
    imageStore(result, pixel, vec4(color, 1.0));
}
