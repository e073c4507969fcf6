// Bilinear fetch of baked lobes around a point of the atlas.
// The includer names two texel buffers first:
//   SG_TEXEL_INDEX  r32ui uimageBuffer [resolution^2]: covered texel, or kNoTexel
//   SG_LOBES        rgba32ui uimageBuffer [texels * lobes]: halves axis.xy, axis.z ln(lambda), amplitude.rg, amplitude.b 0
#ifndef STRANDLIGHT_SG_LOBE_FETCH_GLSL
#define STRANDLIGHT_SG_LOBE_FETCH_GLSL

#include "shared/sg.h"
#include "shared/shade_types.h"

struct SgFootprint
{
    uvec4 first;  // of each corner's lobes in SG_LOBES
    vec4 weights; // sum 1, or all 0 where no corner is covered
};

struct SgSample
{
    vec3 axis;
    float lambda;
    vec3 amplitude;
};

// `place` in texels; texel (x, y) has its centre at (x + 0.5, y + 0.5). Corners without surface get no weight.
SgFootprint sgFootprint(vec2 place, uint resolution, uint lobeCount)
{
    vec2 p = clamp(place - 0.5, vec2(0.0), vec2(float(resolution - 1u)));
    uvec2 low = min(uvec2(p), uvec2(resolution - 1u));
    uvec2 high = min(low + 1u, uvec2(resolution - 1u));
    vec2 f = p - vec2(low);
    uvec4 texel = uvec4(imageLoad(SG_TEXEL_INDEX, int(low.y * resolution + low.x)).x,
                        imageLoad(SG_TEXEL_INDEX, int(low.y * resolution + high.x)).x,
                        imageLoad(SG_TEXEL_INDEX, int(high.y * resolution + low.x)).x,
                        imageLoad(SG_TEXEL_INDEX, int(high.y * resolution + high.x)).x);
    vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    bvec4 empty = equal(texel, uvec4(kNoTexel));
    weights = mix(weights, vec4(0.0), empty);
    float sum = weights.x + weights.y + weights.z + weights.w;
    SgFootprint footprint;
    footprint.weights = sum > 1e-6 ? weights / sum : vec4(0.0);
    footprint.first = mix(texel, uvec4(0u), empty) * lobeCount;
    return footprint;
}

bool sgFootprintEmpty(SgFootprint footprint)
{
    return footprint.weights == vec4(0.0);
}

// Lobe i at the footprint: axis, ln(lambda) and amplitude are interpolated, the axis is normalised after.
SgSample sgFetch(SgFootprint footprint, uint lobe)
{
    vec3 axis = vec3(0.0);
    float logLambda = 0.0;
    vec3 amplitude = vec3(0.0);
    for (int corner = 0; corner < 4; ++corner) {
        uvec4 words = imageLoad(SG_LOBES, int(footprint.first[corner] + lobe));
        float weight = footprint.weights[corner];
        vec2 xy = unpackHalf2x16(words.x);
        vec2 zl = unpackHalf2x16(words.y);
        vec2 rg = unpackHalf2x16(words.z);
        axis += weight * vec3(xy, zl.x);
        logLambda += weight * zl.y;
        amplitude += weight * vec3(rg, unpackHalf2x16(words.w).x);
    }
    SgSample s;
    s.axis = safeNormalize(axis, vec3(0.0, 0.0, 1.0));
    s.lambda = min(exp(logLambda), kSgMaxSharpness);
    s.amplitude = amplitude;
    return s;
}

#endif
