// Strand points under one narrow lobe with a stochastic shadow map along its axis.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"
layout(binding = 5, scalar) readonly buffer Lights { HairLight lights[]; };
layout(binding = 6) uniform sampler2DMS shadowMap;
#include "hair/shadow_map.glsl"
#include "hair/lobe_shade.glsl"

float lobeVisibility(uint lobe, HairLobe light, vec3 position, int point)
{
    HairLight along = lights[lobe];
    return shadowMapVisibility(along, position + along.shadowBias * light.axis, 1, push.shadowSize);
}
