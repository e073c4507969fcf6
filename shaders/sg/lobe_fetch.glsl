// Bilinear fetch of baked lobes around a point of the atlas. Texels keep only the lobes that they need; lobe k is the
// same light in neighbouring texels.
// The includer names two texel buffers first:
//   SG_TEXELS  rg32ui uimageBuffer [resolution^2]: first lobe, mask of the kept ones; (kNoTexel, 0) without surface
//   SG_LOBES   rgba32ui uimageBuffer [kept lobes]: halves axis.xy, axis.z ln(lambda), amplitude.rg, amplitude.b 0
// and loops over footprint.lobes:
//   for (uint rest = footprint.lobes; rest != 0u; rest &= rest - 1u) { sgFetch(footprint, uint(findLSB(rest))); }
#ifndef STRANDLIGHT_SG_LOBE_FETCH_GLSL
#define STRANDLIGHT_SG_LOBE_FETCH_GLSL

#include "shared/sg.h"
#include "shared/shade_types.h"

struct SgFootprint
{
    uvec4 first;  // of each corner's lobes in SG_LOBES
    uvec4 kept;   // each corner's mask, 0 where it has no weight
    vec4 weights; // sum 1, or all 0 where no corner is covered
    uint lobes;   // that any corner keeps
};

struct SgSample
{
    vec3 axis;
    float lambda;
    vec3 amplitude;
};

// `place` in texels; texel (x, y) has its centre at (x + 0.5, y + 0.5). Corners without surface get no weight.
SgFootprint sgFootprint(vec2 place, uint resolution)
{
    vec2 p = clamp(place - 0.5, vec2(0.0), vec2(float(resolution - 1u)));
    uvec2 low = min(uvec2(p), uvec2(resolution - 1u));
    uvec2 high = min(low + 1u, uvec2(resolution - 1u));
    vec2 f = p - vec2(low);
    uvec2 texel[4];
    texel[0] = imageLoad(SG_TEXELS, int(low.y * resolution + low.x)).xy;
    texel[1] = imageLoad(SG_TEXELS, int(low.y * resolution + high.x)).xy;
    texel[2] = imageLoad(SG_TEXELS, int(high.y * resolution + low.x)).xy;
    texel[3] = imageLoad(SG_TEXELS, int(high.y * resolution + high.x)).xy;
    vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    SgFootprint footprint;
    footprint.first = uvec4(texel[0].x, texel[1].x, texel[2].x, texel[3].x);
    weights = mix(weights, vec4(0.0), equal(footprint.first, uvec4(kNoTexel)));
    float sum = weights.x + weights.y + weights.z + weights.w;
    footprint.weights = sum > 1e-6 ? weights / sum : vec4(0.0);
    footprint.kept = mix(uvec4(texel[0].y, texel[1].y, texel[2].y, texel[3].y), uvec4(0u),
                         equal(footprint.weights, vec4(0.0)));
    footprint.lobes = footprint.kept.x | footprint.kept.y | footprint.kept.z | footprint.kept.w;
    return footprint;
}

bool sgFootprintEmpty(SgFootprint footprint)
{
    return footprint.weights == vec4(0.0);
}

// Lobe k of footprint.lobes: axis, ln(lambda) and amplitude are interpolated, the axis is normalised after. A corner
// without the lobe counts as amplitude 0 with axis and sharpness of the others. CPU twin: interpolateLobe.
SgSample sgFetch(SgFootprint footprint, uint lobe)
{
    vec3 axis = vec3(0.0);
    float logLambda = 0.0;
    vec3 amplitude = vec3(0.0);
    float present = 0.0;
    uint bit = 1u << lobe;
    for (int corner = 0; corner < 4; ++corner) {
        uint kept = footprint.kept[corner];
        bool has = (kept & bit) != 0u;
        float weight = has ? footprint.weights[corner] : 0.0;
        uint slot = has ? footprint.first[corner] + bitCount(kept & (bit - 1u)) : 0u;
        uvec4 words = imageLoad(SG_LOBES, int(slot));
        vec2 xy = unpackHalf2x16(words.x);
        vec2 zl = unpackHalf2x16(words.y);
        vec2 rg = unpackHalf2x16(words.z);
        axis += weight * vec3(xy, zl.x);
        logLambda += weight * zl.y;
        amplitude += weight * vec3(rg, unpackHalf2x16(words.w).x);
        present += weight;
    }
    SgSample s;
    s.axis = safeNormalize(axis, vec3(0.0, 0.0, 1.0));
    s.lambda = min(exp(logLambda / present), kSgMaxSharpness);
    s.amplitude = amplitude;
    return s;
}

#endif
