// What a path asks of the scene: the nearest surface that no mask cuts away, and its texture coordinates.
// Part of lib/path.glsl, which says what the including shader provides.
#ifndef STRANDLIGHT_LIB_PATH_SCENE_GLSL
#define STRANDLIGHT_LIB_PATH_SCENE_GLSL

#extension GL_EXT_control_flow_attributes : require

#include "shared/brdf.h"
#include "shared/environment.h"
#include "shared/light_types.h"
#include "shared/octahedral.h"
#include "shared/rng.h"
#include "lib/trace.glsl"
#include "lib/path_material.glsl"

const bool kHasEmitters = (kFeatures & kFeatureEmitters) != 0u;
const bool kHasPunctual = (kFeatures & kFeaturePunctual) != 0u;
const bool kHasEnvironment = (kFeatures & kFeatureEnvironment) != 0u;
const bool kHasAlphaMask = (kFeatures & kFeatureAlphaMask) != 0u;
const bool kHasBaseColorTexture = (kFeatures & kFeatureBaseColorTexture) != 0u;
const bool kHasNormalTexture = (kFeatures & kFeatureNormalTexture) != 0u;
const bool kHasEmissiveTexture = (kFeatures & kFeatureEmissiveTexture) != 0u;
const bool kHasTexCoord1 = (kFeatures & kFeatureTexCoord1) != 0u;
const bool kHasLayer = (kFeatures & kFeatureLayer) != 0u;
// The textures of the scene as kMaterial... bits: features and bits are in the same order.
const uint kTextureBits = (kFeatures / kFeatureBaseColorTexture) & kMaterialAnyTexture;
const bool kHasTexCoords = (kFeatures & (kFeatureBaseColorTexture | kFeatureMetallicRoughnessTexture |
                                         kFeatureNormalTexture | kFeatureEmissiveTexture)) != 0u;

// Masked surfaces that one ray may pass.
const uint kMaskLayers = 16u;
struct PathContext
{
    BvhGrid grid;
    uint triangleCount;
    uint seed;
    uint bounces;
};

vec2 uintPairToVec2(uint a, uint b)
{
    return vec2(uintBitsToFloat(a), uintBitsToFloat(b));
}

vec3 unpackDirection(uint word)
{
    return octDecode(unpackSnorm2x16(word) * 0.5 + 0.5);
}

TexCoords fetchTexCoords(uint slot, float u, float v, uint triangleCount)
{
    TexCoords t;
    t.uv0 = vec2(0.0);
    t.uv1 = vec2(0.0);
    if (kHasTexCoords) {
        uvec4 a = STRANDLIGHT_CORNER(slot * 3u);
        uvec4 b = STRANDLIGHT_CORNER(slot * 3u + 1u);
        uvec4 c = STRANDLIGHT_CORNER(slot * 3u + 2u);
        t.uv0 = uintPairToVec2(a.y, a.z) * (1.0 - u - v) + uintPairToVec2(b.y, b.z) * u + uintPairToVec2(c.y, c.z) * v;
    }
    if (kHasTexCoord1) {
        uvec4 ab = STRANDLIGHT_CORNER(triangleCount * 3u + slot * 2u);
        uvec4 c = STRANDLIGHT_CORNER(triangleCount * 3u + slot * 2u + 1u);
        t.uv1 = uintPairToVec2(ab.x, ab.y) * (1.0 - u - v) + uintPairToVec2(ab.z, ab.w) * u + uintPairToVec2(c.x, c.y) * v;
    }
    return t;
}

uint texturesOf(uint material)
{
    return uint(STRANDLIGHT_MATERIAL_TEXEL(material * kMaterialTexels + 3u).w) & kTextureBits;
}

// The nearest surface, or with anyHit any, that its mask does not cut away.
Hit traceSurface(PathContext context, vec3 origin, vec3 direction, float tMax, bool anyHit)
{
    if (!kHasAlphaMask)
        return traverse(context.grid, origin, direction, 0.0, tMax, anyHit);
    // Behind a hole the search goes on; that needs the hits in order.
    float tMin = 0.0;
    uint rounds = 0u;
    Hit hit;
    for (uint layer = 0u; layer < kMaskLayers; ++layer) {
        hit = traverse(context.grid, origin, direction, tMin, tMax, false);
        rounds += hit.rounds + 1u; // the mask's own lookup
        if (hit.slot == kNoHit)
            break;
        uint material = fetchTriangle(hit.slot * 3u + 1u).w;
        float cutoff = STRANDLIGHT_MATERIAL_TEXEL(material * kMaterialTexels + 3u).z;
        TexCoords t = fetchTexCoords(hit.slot, hit.u, hit.v, context.triangleCount);
        float alpha = STRANDLIGHT_MATERIAL_TEXEL(material * kMaterialTexels).w;
        if (kHasBaseColorTexture)
            alpha *= sampleTextures(material, texturesOf(material) & kMaterialBaseColorTexture, t).baseColor.w;
        if (cutoff < 0.0 || alpha >= cutoff)
            break;
        hit.lost = true; // unless the next layer is solid
        tMin = hit.t;
    }
    hit.rounds = rounds;
    return hit;
}

#endif
