// Strand points under the wide lobes: they see light over much of the sphere, so the smooth visibility does.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/lobe_shade.glsl"
layout(binding = 5, rgba32f) uniform readonly imageBuffer openness;

float lobeVisibility(uint lobe, HairLobe light, vec3 position, int point)
{
    vec4 open = imageLoad(openness, point);
    return clamp(open.w + 3.0 * sgMeanLength(light.sharpness) * dot(open.xyz, light.axis), 0.0, 1.0);
}
