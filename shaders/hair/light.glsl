// A light's irradiance at a point, on a plane that faces it. KHR_lights_punctual.
#ifndef STRANDLIGHT_HAIR_LIGHT_GLSL
#define STRANDLIGHT_HAIR_LIGHT_GLSL

#include "shared/hair_types.h"

vec3 hairLightIrradiance(HairLight light, vec3 position, out vec3 towards)
{
    if (light.type == 2u) {
        towards = -light.direction;
        return light.intensity;
    }
    vec3 path = light.position - position;
    float square = max(dot(path, path), 1e-8);
    towards = path * inversesqrt(square);
    float fall = 1.0 / square;
    if (light.range > 0.0) {
        float reach = square / (light.range * light.range);
        fall *= clamp(1.0 - reach * reach, 0.0, 1.0);
    }
    if (light.type == 1u) {
        float edge = clamp((dot(-towards, light.direction) - light.outerConeCos) /
                               max(light.innerConeCos - light.outerConeCos, 0.001), 0.0, 1.0);
        fall *= edge * edge;
    }
    return light.intensity * fall;
}

#endif
