// Spherical gaussians G(d) = A exp(lambda (dot(d, axis) - 1)): value, integral, product, inner product.
// Wang, Ren, Gong, Snyder, Guo. All-Frequency Rendering of Dynamic, Spatially-Varying Reflectance. 2009
// Tokuyoshi. A Numerically Stable Implementation of the von Mises-Fisher Distribution on S^2. 2025 (stable forms)
//
// All functions take unit axes, lambda in [0, 1e5] and unit amplitude; the caller multiplies by its own.
// The textbook forms lose digits in fp32 (15 % of the value at lambda = 1e6, NaN for opposed axes); these do not.
#ifndef STRANDLIGHT_SHARED_SG_H
#define STRANDLIGHT_SHARED_SG_H

#ifdef __cplusplus
#include "shaders/shared/nan_bits.h"
#include "shaders/shared/sampling.h"
#else
#include "shared/nan_bits.h"
#include "shared/sampling.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// What fp32 can carry: sharper lobes are narrower than the rounding of their axis.
STRANDLIGHT_CONST(float) kSgMaxSharpness = 1.0e5f;

// (1 - exp(-x)) / x for x >= 0, and 1 at 0. GLSL has no expm1, so small x takes the series.
STRANDLIGHT_FN float oneMinusExpOverX(float x)
{
    if (x < 0.5f) {
        return 1.0f - x * (1.0f / 2.0f) *
               (1.0f - x * (1.0f / 3.0f) *
               (1.0f - x * (1.0f / 4.0f) *
               (1.0f - x * (1.0f / 5.0f) *
               (1.0f - x * (1.0f / 6.0f) *
               (1.0f - x * (1.0f / 7.0f))))));
    }
    return (1.0f - exp(-x)) / x;
}

// A unit vector along v, `fallback` when v has no direction: below 1e-30, where a device may flush components to zero,
// or beyond 3e38. NaN stays NaN, so it shows.
STRANDLIGHT_FN vec3 safeNormalize(vec3 v, vec3 fallback)
{
    float size = abs(v.x) + abs(v.y) + abs(v.z); // a sum, not max(), which may drop a NaN
    if (!isNanByBits(size) && (size < 1.0e-30f || size > 3.0e38f)) {
        return fallback;
    }
    // By a power of two first, so that neither squares nor reciprocals leave the range of fp32.
    float large = 1180591620717411303424.0f; // 2^70
    float scale = size > 1.0e18f ? 1.0f / large : (size < 1.0e-18f ? large : 1.0f);
    vec3 scaled = v * scale;
    return scaled / length(scaled);
}

// exp(lambda (dot(d, axis) - 1)) by the half chord: |d - axis|^2 = 2 - 2 dot keeps its digits at small angles.
STRANDLIGHT_FN float sgEvaluate(vec3 d, vec3 axis, float lambda)
{
    vec3 chord = d - axis;
    return exp(-0.5f * lambda * dot(chord, chord));
}

// Over the whole sphere: 2 pi (1 - exp(-2 lambda)) / lambda, 4 pi at lambda = 0.
STRANDLIGHT_FN float sgIntegral(float lambda)
{
    return 4.0f * kPi * oneMinusExpOverX(2.0f * lambda);
}

// G1 G2 = exp(logAmplitude) G(axis, lambda). Opposed equal lobes give lambda = 0 and any axis.
STRANDLIGHT_FN void sgProduct(vec3 axis1, float lambda1, vec3 axis2, float lambda2, STRANDLIGHT_OUT(vec3) axis,
                              STRANDLIGHT_OUT(float) lambda, STRANDLIGHT_OUT(float) logAmplitude)
{
    vec3 sum = axis1 * lambda1 + axis2 * lambda2;
    vec3 chord = axis1 - axis2;
    lambda = length(sum);
    axis = safeNormalize(sum, axis1);
    logAmplitude = -lambda1 * lambda2 * dot(chord, chord) / max(lambda + lambda1 + lambda2, 1.0e-30f);
}

// Integral of G1 G2 over the sphere.
STRANDLIGHT_FN float sgInnerProduct(vec3 axis1, float lambda1, vec3 axis2, float lambda2)
{
    vec3 sum = axis1 * lambda1 + axis2 * lambda2;
    vec3 chord = axis1 - axis2;
    float lambda = length(sum);
    float logAmplitude = -lambda1 * lambda2 * dot(chord, chord) / max(lambda + lambda1 + lambda2, 1.0e-30f);
    return exp(logAmplitude) * sgIntegral(lambda);
}

// Length of the mean direction of a normalised SG: coth(lambda) - 1 / lambda.
STRANDLIGHT_FN float sgMeanLength(float lambda)
{
    if (lambda < 0.5f) {
        float l2 = lambda * lambda;
        return lambda * (1.0f / 3.0f - l2 * (1.0f / 45.0f - l2 * (2.0f / 945.0f - l2 * (1.0f / 4725.0f))));
    }
    float e = exp(-2.0f * lambda);
    return (1.0f + e) / (1.0f - e) - 1.0f / lambda;
}

// The inverse of sgMeanLength for r in [0, 1), by Banerjee's guess and two Newton steps (6e-6 relative).
// Banerjee, Dhillon, Ghosh, Sra. Clustering on the Unit Hypersphere using von Mises-Fisher Distributions. 2005
STRANDLIGHT_FN float sgSharpnessFromMeanLength(float r)
{
    if (r < 1.0e-3f) {
        return 3.0f * max(r, 0.0f);
    }
    float lambda = min(r * (3.0f - r * r) / max(1.0f - r * r, 1.0e-7f), kSgMaxSharpness);
    if (lambda > 50.0f) {
        return min(1.0f / max(1.0f - r, 1.0e-7f), kSgMaxSharpness);
    }
    for (int i = 0; i < 2; ++i) {
        float mean = sgMeanLength(lambda);
        lambda = max(lambda - (mean - r) / (1.0f - mean * mean - 2.0f * mean / lambda), 0.0f);
    }
    return lambda;
}

STRANDLIGHT_SHARED_END

#endif
