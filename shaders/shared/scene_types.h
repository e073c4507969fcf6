// Materials, textures and punctual lights as the shaders read them.
//
// Materials are made of whole vec4s and only floats, so that one rgba32f texel buffer (the fast gather on every
// device) can hold the array: material i is texels [kMaterialTexels * i, kMaterialTexels * (i + 1)).
#ifndef STRANDLIGHT_SHARED_SCENE_TYPES_H
#define STRANDLIGHT_SHARED_SCENE_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Two texels. uv' = (dot(rowU, (u, v, 1)), dot(rowV, (u, v, 1))).
struct GpuTextureSlot
{
    vec3 rowU;
    float texture; // index into the pool's table, < 0: none
    vec3 rowV;
    float texCoord; // 0 or 1
};

struct GpuMaterial
{
    vec4 baseColor;     // linear
    vec3 emissive;      // W / (sr m^2)
    float metallic;
    vec3 specularColor; // KHR_materials_specular
    float specular;
    float roughness;    // perceptual
    float normalScale;
    float alphaCutoff;  // < 0: opaque
    float flags;        // sum of kMaterial... bits
    GpuTextureSlot baseColorTexture;
    GpuTextureSlot metallicRoughnessTexture;
    GpuTextureSlot normalTexture;
    GpuTextureSlot emissiveTexture;
};

STRANDLIGHT_CONST(uint) kMaterialTexels = 12u;
// Bits of GpuMaterial::flags. The shader looks at the flags first: what a material has not is not read.
STRANDLIGHT_CONST(uint) kMaterialBaseColorTexture = 1u;
STRANDLIGHT_CONST(uint) kMaterialMetallicRoughnessTexture = 2u;
STRANDLIGHT_CONST(uint) kMaterialNormalTexture = 4u;
STRANDLIGHT_CONST(uint) kMaterialEmissiveTexture = 8u;
STRANDLIGHT_CONST(uint) kMaterialDoubleSided = 16u;
STRANDLIGHT_CONST(uint) kMaterialAnyTexture = 15u;

// The texture pool's word array begins with one record of this many words per texture:
//   0: width | height << 16   1: levels | wrapU << 8 | wrapV << 10 | srgb << 12   2: unused
//   3 + level: where the level's texels start, in words of the same array; a texel is RGBA8, red in the low byte.
STRANDLIGHT_CONST(uint) kTextureRecordWords = 18u;
STRANDLIGHT_CONST(uint) kTextureMaximumLevels = 15u;

struct GpuLight
{
    vec3 position;
    uint type; // LightType: 0 point, 1 spot, 2 directional
    vec3 direction; // the way the light travels, unit
    float range;    // metres, 0: infinite
    vec3 intensity; // candela, or lux for directional lights
    float coneScale;  // spot: 1 / (cos inner - cos outer)
    float coneOffset; // spot: -cos outer * coneScale
};

// Irradiance on a surface at `point` that faces a punctual light, and the unit direction and distance to the light.
// Window of the range and spot attenuation as KHR_lights_punctual recommends.
STRANDLIGHT_FN vec3 punctualIrradiance(GpuLight light, vec3 point, STRANDLIGHT_OUT(vec3) toLight,
                                       STRANDLIGHT_OUT(float) distanceToLight)
{
    if (light.type == 2u) {
        toLight = -light.direction;
        distanceToLight = 1e30f;
        return light.intensity;
    }
    vec3 offset = light.position - point;
    float squared = dot(offset, offset);
    distanceToLight = sqrt(squared);
    if (!(squared > 0.0f)) {
        toLight = vec3(0.0f, 1.0f, 0.0f);
        return vec3(0.0f);
    }
    toLight = offset / distanceToLight;
    float attenuation = 1.0f / squared;
    if (light.range > 0.0f) {
        float ratio = distanceToLight / light.range;
        float ratio4 = ratio * ratio * ratio * ratio;
        attenuation *= ratio4 < 1.0f ? 1.0f - ratio4 : 0.0f;
    }
    if (light.type == 1u) {
        float cone = -dot(light.direction, toLight) * light.coneScale + light.coneOffset;
        cone = cone < 0.0f ? 0.0f : (cone > 1.0f ? 1.0f : cone);
        attenuation *= cone * cone;
    }
    return light.intensity * attenuation;
}

STRANDLIGHT_SHARED_END

#endif
