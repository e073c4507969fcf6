// Strand points under a light with a stochastic shadow map: the share of 3 x 3 texels' samples that lie behind.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
layout(binding = 5) uniform sampler2DMS shadowMap;
#include "hair/shade.glsl"

float lightVisibility(HairLight light, vec3 position, vec3 towards, uint point)
{
    vec4 clip = light.shadowMatrix * vec4(position + light.shadowBias * towards, 1.0);
    if (!(clip.w > 0.0)) {
        return 1.0;
    }
    vec3 place = clip.xyz / clip.w;
    ivec2 centre = ivec2(floor((place.xy * 0.5 + 0.5) * float(push.shadowSize)));
    ivec2 last = ivec2(int(push.shadowSize) - 1);
    int lit = 0;
    for (int tap = 0; tap < 9; ++tap) {
        ivec2 texel = clamp(centre + ivec2(tap % 3 - 1, tap / 3 - 1), ivec2(0), last);
        for (int s = 0; s < 4; ++s) {
            lit += texelFetch(shadowMap, texel, s).x >= place.z ? 1 : 0;
        }
    }
    return float(lit) / 36.0;
}
