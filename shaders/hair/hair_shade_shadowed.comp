// Strand points under a light with a stochastic shadow map.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
layout(binding = 5) uniform sampler2DMS shadowMap;
#include "hair/shadow_map.glsl"
#include "hair/shade.glsl"

float lightVisibility(HairLight light, vec3 position, vec3 towards, uint point)
{
    return shadowMapVisibility(light, position + light.shadowBias * towards, 1, push.shadowSize);
}
