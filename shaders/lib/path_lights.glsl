// Light sampling for next-event estimation: the environment by its importance grid, emissive triangles and punctual lights
// by power. Part of lib/path.glsl, which declares the features and the context.
#ifndef STRANDLIGHT_LIB_PATH_LIGHTS_GLSL
#define STRANDLIGHT_LIB_PATH_LIGHTS_GLSL

#include "lib/path_scene.glsl"

// --- Environment ---------------------------------------------------------------------------------------------------

vec3 fetchEnvironment(ivec2 texel, ivec2 size)
{
    int x = texel.x < 0 ? texel.x + size.x : (texel.x >= size.x ? texel.x - size.x : texel.x);
    int y = clamp(texel.y, 0, size.y - 1);
    return STRANDLIGHT_ENVIRONMENT(y * size.x + x).xyz;
}

// Bilinear, like environmentRadiance() on the CPU.
vec3 environmentRadiance(vec2 uv, ivec2 size)
{
    vec2 p = uv * vec2(size) - 0.5;
    vec2 base = floor(p);
    vec2 f = p - base;
    ivec2 t = ivec2(base);
    vec3 low = mix(fetchEnvironment(t, size), fetchEnvironment(t + ivec2(1, 0), size), f.x);
    vec3 high = mix(fetchEnvironment(t + ivec2(0, 1), size), fetchEnvironment(t + ivec2(1, 1), size), f.x);
    return mix(low, high, f.y);
}

// Density over solid angle of a cell's density over (u, v).
float environmentPdf(float density, vec3 direction)
{
    float sine = sqrt(max(1.0 - direction.y * direction.y, 0.0));
    return sine > 1e-6 ? density / (2.0 * kPi * kPi * sine) : 0.0;
}

float environmentDensity(vec2 uv, uvec2 grid, ivec2 size)
{
    uvec2 cell = min(uvec2(uv * vec2(grid)), grid - 1u);
    return STRANDLIGHT_ENVIRONMENT(uint(size.x * size.y) + cell.y * grid.x + cell.x).z;
}

// --- Light sampling ------------------------------------------------------------------------------------------------

struct LightSample
{
    vec3 direction;
    float distanceTo;
    vec3 radiance;  // for delta lights: irradiance
    float pdf;      // over solid angle; for delta lights the probability of the choice
    bool delta;
};

vec3 emissionOf(uint material, TexCoords t)
{
    vec3 emission = STRANDLIGHT_MATERIAL_TEXEL(material * kMaterialTexels + 1u).xyz;
    if (kHasEmissiveTexture)
        emission *= sampleTextures(material, texturesOf(material) & kMaterialEmissiveTexture, t).emissive.xyz;
    return emission;
}

LightSample sampleEmitter(PathContext context, uvec4 header, vec3 position, vec3 uniforms, float probability)
{
    AliasDraw draw = drawAlias(uniforms.z, header.x);
    uvec4 entry = STRANDLIGHT_LIGHT_TABLE(kLightTableHeader + draw.column);
    if (draw.rest >= uintBitsToFloat(entry.x))
        entry = STRANDLIGHT_LIGHT_TABLE(kLightTableHeader + entry.y);
    bool punctual = kHasPunctual && (entry.z & kPunctualBit) != 0u;
    uint slot = punctual ? 0u : entry.z;

    uvec4 c0 = fetchTriangle(slot * 3u);
    uvec4 c1 = fetchTriangle(slot * 3u + 1u);
    uvec4 c2 = fetchTriangle(slot * 3u + 2u);
    vec2 w = sampleTriangle(uniforms.x, uniforms.y);
    vec3 p0 = positionOf(c0);
    vec3 e1 = positionOf(c1) - p0;
    vec3 e2 = positionOf(c2) - p0;
    vec3 normal = cross(e1, e2);
    normal *= inversesqrt(max(dot(normal, normal), 1e-36));
    vec3 offset = p0 + e1 * w.x + e2 * w.y - position;
    float squared = max(dot(offset, offset), 1e-30);

    LightSample light;
    light.distanceTo = sqrt(squared);
    light.direction = offset / light.distanceTo;
    float cosine = -dot(normal, light.direction);
    uint flags = uint(STRANDLIGHT_MATERIAL_TEXEL(c1.w * kMaterialTexels + 3u).w);
    bool shines = cosine > 0.0 || (flags & kMaterialDoubleSided) != 0u;
    vec3 emission = emissionOf(c1.w, fetchTexCoords(slot, w.x, w.y, context.triangleCount));
    light.radiance = shines ? emission : vec3(0.0);
    float density = uintBitsToFloat(c2.w) * squared / max(abs(cosine), 1e-9);
    light.pdf = probability * (abs(cosine) > 1e-9 ? density : 0.0);
    light.delta = false;
    if (punctual) {
        light.radiance = punctualIrradiance(STRANDLIGHT_PUNCTUAL(entry.z & ~kPunctualBit), position, light.direction,
                                            light.distanceTo);
        light.pdf = probability * uintBitsToFloat(entry.w);
        light.delta = true;
    }
    return light;
}

LightSample sampleEnvironment(uvec4 header, ivec2 size, vec3 uniforms, float probability)
{
    uint cells = header.z * header.w;
    uint first = uint(size.x * size.y);
    AliasDraw draw = drawAlias(uniforms.z, cells);
    vec4 cell = STRANDLIGHT_ENVIRONMENT(first + draw.column);
    uint index = draw.column;
    if (draw.rest >= cell.x) {
        index = uint(cell.y);
        cell = STRANDLIGHT_ENVIRONMENT(first + index);
    }
    vec2 uv = (vec2(float(index % header.z), float(index / header.z)) + uniforms.xy) / vec2(header.zw);
    LightSample light;
    light.direction = environmentDirection(uv.x, uv.y);
    light.distanceTo = 1e30;
    light.radiance = environmentRadiance(uv, size);
    light.pdf = probability * environmentPdf(cell.z, light.direction);
    light.delta = false;
    return light;
}

#endif
