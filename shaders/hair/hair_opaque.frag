// Plain diffuse shading of what is behind hair, where no finished picture of it is given. Shadows are
// looked up at corners.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/light.glsl"
#include "shared/sg.h"
#include "shared/sg_diffuse.h"

layout(binding = 1, scalar) readonly buffer Lights { HairLight lights[]; };
layout(binding = 3, scalar) readonly buffer Lobes { HairLobe lobes[]; };
layout(push_constant, scalar) uniform Push { HairOpaquePush push; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 albedo;
layout(location = 3) in vec4 lightShares;
layout(location = 0) out vec4 color; // radiance, 0: no hair

void main()
{
    vec3 irradiance = push.ambient * 3.14159265;
    for (uint i = 0u; i < push.lightCount; ++i) {
        vec3 towards;
        vec3 facing = hairLightIrradiance(lights[i], position, towards);
        facing *= i < kHairSurfaceLights ? lightShares[i] : 1.0;
        irradiance += facing * max(dot(normalize(normal), towards), 0.0);
    }
    for (uint i = 0u; i < push.lobeCount; ++i) {
        HairLobe lobe = lobes[i];
        irradiance += lobe.energy / sgIntegral(lobe.sharpness) *
                      sgIrradiance(lobe.sharpness, dot(normalize(normal), lobe.axis));
    }
    color = vec4(albedo * irradiance / 3.14159265, 0.0);
}
