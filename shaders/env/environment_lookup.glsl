// Bilinear and trilinear look-ups in the environment's pyramid and its prefiltered levels.
// The includer defines ENVIRONMENT_PYRAMID and ENVIRONMENT_PREFILTERED as names of rgba32f imageBuffers (the second is
// optional) before including.
#ifndef STRANDLIGHT_ENV_ENVIRONMENT_LOOKUP_GLSL
#define STRANDLIGHT_ENV_ENVIRONMENT_LOOKUP_GLSL

#include "shared/environment.h"
#include "shared/sampling.h"
#include "shared/shade_types.h"

// The four texels around (u, v) of a lat-long picture: u wraps, v clamps at the poles.
void latLongFootprint(vec2 uv, uint width, uint height, out uvec4 texels, out vec2 blend)
{
    vec2 p = vec2(uv.x * float(width), uv.y * float(height)) - 0.5;
    vec2 base = floor(p);
    blend = p - base;
    int w = int(width);
    int h = int(height);
    uint x0 = uint((int(base.x) + w) % w);
    uint x1 = (x0 + 1u) % width;
    uint y0 = uint(clamp(int(base.y), 0, h - 1));
    uint y1 = uint(clamp(int(base.y) + 1, 0, h - 1));
    texels = uvec4(y0 * width + x0, y0 * width + x1, y1 * width + x0, y1 * width + x1);
}

// Offset and size of a pyramid level.
void pyramidLevel(EnvironmentShape shape, uint level, out uint offset, out uint width, out uint height)
{
    offset = 0u;
    width = shape.width;
    height = shape.height;
    for (uint i = 0u; i < level; ++i) {
        offset += width * height;
        width = max(width / 2u, 1u);
        height = max(height / 2u, 1u);
    }
}

vec3 pyramidTexel(EnvironmentShape shape, vec2 uv, uint level)
{
    uint offset;
    uint width;
    uint height;
    pyramidLevel(shape, level, offset, width, height);
    uvec4 texels;
    vec2 blend;
    latLongFootprint(uv, width, height, texels, blend);
    vec3 top = mix(imageLoad(ENVIRONMENT_PYRAMID, int(offset + texels.x)).rgb,
                   imageLoad(ENVIRONMENT_PYRAMID, int(offset + texels.y)).rgb, blend.x);
    vec3 bottom = mix(imageLoad(ENVIRONMENT_PYRAMID, int(offset + texels.z)).rgb,
                      imageLoad(ENVIRONMENT_PYRAMID, int(offset + texels.w)).rgb, blend.x);
    return mix(top, bottom, blend.y);
}

// Trilinear; `level` may lie between levels and beyond them.
vec3 pyramidRadiance(EnvironmentShape shape, vec2 uv, float level)
{
    float clamped = clamp(level, 0.0, float(shape.levels - 1u));
    uint low = uint(clamped);
    vec3 radiance = pyramidTexel(shape, uv, low);
    if (clamped > float(low)) {
        radiance = mix(radiance, pyramidTexel(shape, uv, low + 1u), clamped - float(low));
    }
    return radiance;
}

#ifdef ENVIRONMENT_PREFILTERED
vec3 prefilteredTexels(uvec4 texels, vec2 blend, uint level)
{
    uint offset = level * kPrefilterWidth * kPrefilterHeight;
    vec3 top = mix(imageLoad(ENVIRONMENT_PREFILTERED, int(offset + texels.x)).rgb,
                   imageLoad(ENVIRONMENT_PREFILTERED, int(offset + texels.y)).rgb, blend.x);
    vec3 bottom = mix(imageLoad(ENVIRONMENT_PREFILTERED, int(offset + texels.z)).rgb,
                      imageLoad(ENVIRONMENT_PREFILTERED, int(offset + texels.w)).rgb, blend.x);
    return mix(top, bottom, blend.y);
}

// Mean radiance over a normalised SG.
vec3 prefilteredRadiance(EnvironmentShape shape, vec3 direction, float sharpness)
{
    float level = log(1.0 + sharpness) / kPrefilterStep;
    float last = float(kPrefilterLevels - 1u);
    vec2 uv = environmentUv(direction);
    vec3 wide = vec3(0.0);
    if (level < last) {
        uvec4 texels;
        vec2 blend;
        latLongFootprint(uv, kPrefilterWidth, kPrefilterHeight, texels, blend);
        uint low = uint(level);
        wide = mix(prefilteredTexels(texels, blend, low), prefilteredTexels(texels, blend, low + 1u),
                   level - float(low));
        if (level <= last - 1.0) {
            return wide;
        }
    }
    // Bilinear look-up of box-filtered texels of width h has the variance h^2 / 4; an SG has 1 / sharpness.
    float texel = 2.0 * kPi / float(shape.width);
    vec3 narrow = pyramidRadiance(shape, uv, log2(2.0 * inversesqrt(sharpness) / texel));
    return level >= last ? narrow : mix(wide, narrow, level - (last - 1.0));
}
#endif

#endif
