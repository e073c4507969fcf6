// The three specular models behind one call. The includer names the table's sampler2DArray SG_SPECULAR_TABLE.
#ifndef STRANDLIGHT_SG_SPECULAR_MODELS_GLSL
#define STRANDLIGHT_SG_SPECULAR_MODELS_GLSL

#include "shared/sg_specular.h"
#include "shared/shade_types.h"

SgMixture specularMixtureAt(float alpha, vec3 normal, vec3 view)
{
    vec2 uv = specularTableUv(alpha, dot(normal, view));
    return specularMixture(textureLod(SG_SPECULAR_TABLE, vec3(uv, 0.0), 0.0),
                           textureLod(SG_SPECULAR_TABLE, vec3(uv, 1.0), 0.0),
                           textureLod(SG_SPECULAR_TABLE, vec3(uv, 2.0), 0.0),
                           textureLod(SG_SPECULAR_TABLE, vec3(uv, 3.0), 0.0), normal, view);
}

SgMeanLobes specularMeanLobesAt(float alpha, vec3 normal, vec3 view)
{
    vec2 uv = specularTableUv(alpha, dot(normal, view));
    vec4 weights = vec4(textureLod(SG_SPECULAR_TABLE, vec3(uv, 0.0), 0.0).z,
                        textureLod(SG_SPECULAR_TABLE, vec3(uv, 1.0), 0.0).z,
                        textureLod(SG_SPECULAR_TABLE, vec3(uv, 2.0), 0.0).z,
                        textureLod(SG_SPECULAR_TABLE, vec3(uv, 3.0), 0.0).z);
    return specularMeanLobes(weights, textureLod(SG_SPECULAR_TABLE, vec3(uv, 4.0), 0.0),
                             textureLod(SG_SPECULAR_TABLE, vec3(uv, 5.0), 0.0), alpha, normal, view);
}

// Reflected radiance of a unit light lobe = f0 x + f90 y.
vec2 specularResponse(uint model, SgMixture mixture, float alpha, vec3 normal, vec3 view, vec3 axis, float lambda)
{
    if (model == kSpecularMixture) {
        return sgSpecularMixture(mixture, normal, view, axis, lambda);
    }
    // The alternatives take Fresnel at one direction: the lobe's centre (ASG) or the light's axis (NDF filter).
    if (model == kSpecularAsg) {
        float value = sgSpecularAsg(alpha, normal, view, axis, lambda);
        float weight = schlickWeight(view, normal * (2.0 * dot(normal, view)) - view);
        return vec2(value - value * weight, value * weight);
    }
    float value = sgSpecularNdfFilter(alpha, normal, view, axis, lambda);
    float weight = schlickWeight(view, axis);
    return vec2(value - value * weight, value * weight);
}

#endif
