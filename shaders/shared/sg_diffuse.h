// Integrals of a spherical gaussian over a hemisphere, plain and with the clamped cosine (diffuse irradiance).
// Tokuyoshi, Ikeda, Kulkarni, Harada. Hierarchical Light Sampling with Accurate Spherical Gaussian Lighting. 2024
// Tokuyoshi. Accurate Diffuse Lighting from Spherical Gaussian Lights. 2022 (hemispherical integral)
// Meder, Bruederlin. Hemispherical Gaussians for Accurate Light Integration. 2018 (between lower and upper lobe)
// Hill. A fit of SG irradiance, in Pettineo. SG Series, part 3. 2016 (named alternative; not below lambda = 1)
// Wang, Ren, Gong, Snyder, Guo. All-Frequency Rendering. 2009 (the cosine as an SG; named alternative)
//
// All take unit amplitude, lambda in [0, 1e5] and cosine = dot(axis, normal) in [-1, 1].
#ifndef STRANDLIGHT_SHARED_SG_DIFFUSE_H
#define STRANDLIGHT_SHARED_SG_DIFFUSE_H

#ifdef __cplusplus
#include "shaders/shared/erf.h"
#include "shaders/shared/sg.h"
#else
#include "shared/erf.h"
#include "shared/sg.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Share of the way from the SG on the lower hemisphere to the SG on the upper one, in [0, 1].
STRANDLIGHT_FN float sgHemisphereBlend(float lambda, float cosine)
{
    float t = lambda * sqrt((0.5f * lambda + 0.65173288f) / ((lambda + 1.34182800f) * lambda + 7.22166878f));
    if (t < 1.0e-4f) {
        return 0.5f + 0.5f * cosine; // both error functions are linear here
    }
    return clamp(0.5f + 0.5f * errorFunction(t * cosine) / errorFunction(t), 0.0f, 1.0f);
}

// Integral of the SG over the hemisphere around the normal.
STRANDLIGHT_FN float sgHemisphereIntegral(float lambda, float cosine)
{
    float lower = exp(-lambda);
    return 2.0f * kPi * oneMinusExpOverX(lambda) * (lower + (1.0f - lower) * sgHemisphereBlend(lambda, cosine));
}

// The same as a share of the integral over the sphere, in [0, 1].
STRANDLIGHT_FN float sgHemisphereFraction(float lambda, float cosine)
{
    float lower = exp(-lambda);
    return (lower + (1.0f - lower) * sgHemisphereBlend(lambda, cosine)) / (1.0f + lower);
}

// Integral of SG times cosine over the hemisphere for an SG along the normal, divided by 2 pi: (1 - phi(lambda)) / lambda.
STRANDLIGHT_FN float sgCosineUpper(float lambda)
{
    if (lambda < 1.0f) {
        return 0.5f - lambda * (1.0f / 6.0f) *
               (1.0f - lambda * (1.0f / 4.0f) *
               (1.0f - lambda * (1.0f / 5.0f) *
               (1.0f - lambda * (1.0f / 6.0f) *
               (1.0f - lambda * (1.0f / 7.0f) *
               (1.0f - lambda * (1.0f / 8.0f) *
               (1.0f - lambda * (1.0f / 9.0f)))))));
    }
    return (1.0f - oneMinusExpOverX(lambda)) / lambda;
}

// The same for an SG opposed to the normal: exp(-lambda) (phi(lambda) - exp(-lambda)) / lambda.
STRANDLIGHT_FN float sgCosineLower(float lambda)
{
    float e = exp(-lambda);
    if (lambda < 0.5f) {
        float p = 1.0f / 45360.0f;
        p = 1.0f / 5760.0f - lambda * p;
        p = 1.0f / 840.0f - lambda * p;
        p = 1.0f / 144.0f - lambda * p;
        p = 1.0f / 30.0f - lambda * p;
        p = 1.0f / 8.0f - lambda * p;
        p = 1.0f / 3.0f - lambda * p;
        return e * (0.5f - lambda * p);
    }
    return e * (oneMinusExpOverX(lambda) - e) / lambda;
}

// Integral of SG times clamped cosine over the sphere: irradiance of a unit lobe. Error <= 1.3e-3 of the lobe's energy.
STRANDLIGHT_FN float sgIrradiance(float lambda, float cosine)
{
    float t = lambda * sqrt(((lambda + 2.73608316f) * lambda + 17.02129778f) /
                            (2.0f * (((lambda + 4.01008267f) * lambda + 15.21915626f) * lambda + 76.08789627f)));
    float sine2 = max((1.0f - cosine) * (1.0f + cosine), 0.0f);
    float tc = t * cosine;
    // exp(-t^2 c^2) (1 - exp(-t^2 (1 - c^2))) / t, with the division done by oneMinusExpOverX
    float edge = exp(-tc * tc) * t * sine2 * oneMinusExpOverX(t * t * sine2);
    float blend = 0.5f * (cosine * errorFunctionComplement(-tc) + errorFunctionComplement(t)) + 0.28209479f * edge;
    float lower = sgCosineLower(lambda);
    float upper = sgCosineUpper(lambda);
    return 2.0f * kPi * (lower + (upper - lower) * clamp(blend, 0.0f, 1.0f));
}

// Hill's fit: cheaper, 2e-2 of the energy for lambda >= 1, diverges below.
STRANDLIGHT_FN float sgIrradianceHill(float lambda, float cosine)
{
    float e1 = exp(-lambda);
    float e2 = e1 * e1;
    float inverse = 1.0f / lambda;
    float scale = 1.0f + 2.0f * e2 - inverse;
    float bias = (e1 - e2) * inverse - e2;
    float x = sqrt(max(1.0f - scale, 1.0e-12f));
    float x0 = 0.36f * cosine;
    float x1 = x / (4.0f * 0.36f);
    float n = x0 + x1;
    float y = abs(x0) <= x1 ? n * n / x : clamp(cosine, 0.0f, 1.0f);
    return 2.0f * kPi * inverse * (scale * y + bias);
}

// The cosine as an SG of sharpness 2.133 and amplitude 1.17: cheapest, up to 17 % of the energy wrong.
STRANDLIGHT_FN float sgIrradianceWang(float lambda, float cosine)
{
    float sum = sqrt(max(lambda * lambda + 2.133f * 2.133f + 2.0f * lambda * 2.133f * cosine, 0.0f));
    float logAmplitude = -2.0f * lambda * 2.133f * (1.0f - cosine) / (sum + lambda + 2.133f);
    return 1.17f * exp(logAmplitude) * sgIntegral(sum);
}

STRANDLIGHT_SHARED_END

#endif
