// Textures and materials from texel buffers: works on devices without descriptor indexing.
//
// The including shader binds two texel buffers and names them before the include:
//   #define STRANDLIGHT_TEXTURE_WORD(i) imageLoad(textureWords, int(i)).x    // r32ui uimageBuffer, TexturePool::words
//   #define STRANDLIGHT_MATERIAL_TEXEL(i) imageLoad(materialTexels, int(i))  // rgba32f imageBuffer, packMaterials
// The C++ twin is engine/scene/texture_pool.hpp.
#ifndef STRANDLIGHT_LIB_TEXTURES_GLSL
#define STRANDLIGHT_LIB_TEXTURES_GLSL

#include "shared/scene_types.h"

// `lod` for callers that always want the full resolution.
const float kFullResolution = -100.0;

struct SurfaceMaterial
{
    vec3 baseColor;
    float alpha;
    float metallic;
    float roughness;     // perceptual
    vec3 emissive;       // W / (sr m^2)
    vec3 normal;         // tangent space (T, B, N), unit; (0, 0, 1) without a normal map
    float specular;
    vec3 specularColor;
    float alphaCutoff;   // < 0: opaque
    bool doubleSided;
};

float srgbToLinear(float c)
{
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

// Texel index along one axis after wrapping: 0 repeat, 1 clamp, 2 mirrored repeat. The repeating ones take i >= -size:
// the remainder of a negative number is undefined.
int wrapTexel(int i, int size, uint mode)
{
    if (mode == 1u)
        return clamp(i, 0, size - 1);
    int period = mode == 2u ? 2 * size : size;
    int m = (i + period) % period;
    return m < size ? m : period - 1 - m;
}

vec4 fetchTexel(uint start, ivec2 size, ivec2 texel, uint flags)
{
    int x = wrapTexel(texel.x, size.x, (flags >> 8u) & 3u);
    int y = wrapTexel(texel.y, size.y, (flags >> 10u) & 3u);
    vec4 c = unpackUnorm4x8(STRANDLIGHT_TEXTURE_WORD(start + uint(y * size.x + x)));
    if ((flags & 0x1000u) != 0u)
        c.rgb = vec3(srgbToLinear(c.r), srgbToLinear(c.g), srgbToLinear(c.b));
    return c;
}

vec4 fetchBilinear(uint record, uint level, ivec2 size, vec2 uv, uint flags)
{
    uint start = STRANDLIGHT_TEXTURE_WORD(record + 3u + level);
    size = max(size >> int(level), ivec2(1));
    // Whole repeats are taken off first (two, for the mirrored mode): int() of a far away coordinate is undefined.
    if (((flags >> 8u) & 3u) != 1u)
        uv.x -= 2.0 * floor(0.5 * uv.x);
    if (((flags >> 10u) & 3u) != 1u)
        uv.y -= 2.0 * floor(0.5 * uv.y);
    vec2 p = clamp(uv, vec2(-2.0), vec2(3.0)) * vec2(size) - 0.5;
    vec2 base = floor(p);
    vec2 f = p - base;
    ivec2 t = ivec2(base);
    vec4 low = mix(fetchTexel(start, size, t, flags), fetchTexel(start, size, t + ivec2(1, 0), flags), f.x);
    vec4 high = mix(fetchTexel(start, size, t + ivec2(0, 1), flags),
                    fetchTexel(start, size, t + ivec2(1, 1), flags), f.x);
    return mix(low, high, f.y);
}

// Trilinear. `lod` is log2 of the footprint's width in texture coordinates.
vec4 sampleTexture(uint texture_, vec2 uv, float lod)
{
    uint record = texture_ * kTextureRecordWords;
    uint sizeWord = STRANDLIGHT_TEXTURE_WORD(record);
    uint flags = STRANDLIGHT_TEXTURE_WORD(record + 1u);
    ivec2 size = ivec2(int(sizeWord & 0xffffu), int(sizeWord >> 16u));
    float last = float((flags & 0xffu) - 1u);
    float level = clamp(lod + log2(float(max(size.x, size.y))), 0.0, last);
    uint fine = uint(level);
    float blend = level - float(fine);
    vec4 color = fetchBilinear(record, fine, size, uv, flags);
    if (blend > 0.0)
        color = mix(color, fetchBilinear(record, fine + 1u, size, uv, flags), blend);
    return color;
}

// The texture of a slot whose two texels start at `texel`.
vec4 sampleSlot(uint texel, vec2 uv0, vec2 uv1, float lod)
{
    vec4 a = STRANDLIGHT_MATERIAL_TEXEL(texel);
    vec4 b = STRANDLIGHT_MATERIAL_TEXEL(texel + 1u);
    vec3 uv = vec3(b.w > 0.5 ? uv1 : uv0, 1.0);
    // The transform stretches the footprint by about the square root of its area.
    float scale = abs(a.x * b.y - a.y * b.x);
    float slotLod = lod + 0.5 * log2(max(scale, 1e-20));
    return sampleTexture(uint(a.w), vec2(dot(a.xyz, uv), dot(b.xyz, uv)), slotLod);
}

// Only the alpha of a material that masks: for shadow and visibility rays.
float evaluateAlpha(uint material, vec2 uv0, vec2 uv1)
{
    uint first = material * kMaterialTexels;
    float alpha = STRANDLIGHT_MATERIAL_TEXEL(first).w;
    uint flags = uint(STRANDLIGHT_MATERIAL_TEXEL(first + 3u).w);
    if ((flags & kMaterialBaseColorTexture) != 0u)
        alpha *= sampleSlot(first + 4u, uv0, uv1, kFullResolution).w;
    return alpha;
}

// All that shading needs of a material at a surface point. `lod`: log2 of the pixel's width in texture coordinates,
// kFullResolution for the finest level.
SurfaceMaterial evaluateMaterial(uint material, vec2 uv0, vec2 uv1, float lod)
{
    uint first = material * kMaterialTexels;
    vec4 color = STRANDLIGHT_MATERIAL_TEXEL(first);
    vec4 emissiveMetallic = STRANDLIGHT_MATERIAL_TEXEL(first + 1u);
    vec4 specular = STRANDLIGHT_MATERIAL_TEXEL(first + 2u);
    vec4 rest = STRANDLIGHT_MATERIAL_TEXEL(first + 3u);
    uint flags = uint(rest.w);

    SurfaceMaterial m;
    m.metallic = emissiveMetallic.w;
    m.roughness = rest.x;
    m.emissive = emissiveMetallic.xyz;
    m.normal = vec3(0.0, 0.0, 1.0);
    m.specular = specular.w;
    m.specularColor = specular.xyz;
    m.alphaCutoff = rest.z;
    m.doubleSided = (flags & kMaterialDoubleSided) != 0u;
    if ((flags & kMaterialAnyTexture) != 0u) {
        if ((flags & kMaterialBaseColorTexture) != 0u)
            color *= sampleSlot(first + 4u, uv0, uv1, lod);
        if ((flags & kMaterialMetallicRoughnessTexture) != 0u) {
            vec4 t = sampleSlot(first + 6u, uv0, uv1, lod);
            m.roughness *= t.y;
            m.metallic *= t.z;
        }
        if ((flags & kMaterialNormalTexture) != 0u) {
            vec3 t = 2.0 * sampleSlot(first + 8u, uv0, uv1, lod).xyz - 1.0;
            t = vec3(t.xy * rest.y, t.z);
            float squared = dot(t, t);
            m.normal = squared > 1e-12 ? t * inversesqrt(squared) : vec3(0.0, 0.0, 1.0);
        }
        if ((flags & kMaterialEmissiveTexture) != 0u)
            m.emissive *= sampleSlot(first + 10u, uv0, uv1, lod).xyz;
    }
    m.baseColor = color.xyz;
    m.alpha = color.w;
    return m;
}

#endif
