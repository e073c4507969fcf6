// A hair fibre under a distant spherical gaussian: the integral of the lobe times hairScatter in closed form.
// Ren, Zhou, Li, Hou, Guo. Interactive Hair Rendering under Environment Lighting. 2010 (lights as Gaussians)
// Xu, Ma, Ren, Wang. Interactive Hair Rendering and Appearance Editing under Environment Lighting. 2011
// d'Eon's longitudinal density is the marginal of an SG over the azimuth, so light and fibre convolve as SGs on the
// sphere: mean directions multiply. About the fibre both are von Mises densities, which do the same on the circle.
#ifndef STRANDLIGHT_SHARED_HAIR_LOBE_H
#define STRANDLIGHT_SHARED_HAIR_LOBE_H

#ifdef __cplusplus
#include "shaders/shared/hair_bsdf.h"
#include "shaders/shared/sg.h"
#else
#include "shared/hair_bsdf.h"
#include "shared/sg.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Length of the mean direction of exp(k cos(phi)) on the circle, I1(k) / I0(k), and back: 1.4 % at most.
// Amos. Computation of Modified Bessel Functions and Their Ratios. 1974
STRANDLIGHT_FN float vonMisesMeanLength(float k)
{
    return k / (0.5f + sqrt(k * k + 2.25f));
}

STRANDLIGHT_FN float vonMisesSharpness(float r)
{
    return r * (1.0f + sqrt(max(9.0f - 8.0f * r * r, 0.0f))) / (2.0f * max(1.0f - r * r, 1e-6f));
}

// Density of exp(k cos(phi)) over the circle.
STRANDLIGHT_FN float vonMisesDensity(float k, float cosPhi)
{
    return 0.159154943f * exp(k * (cosPhi - 1.0f) - hairLogBesselI0(k));
}

// Longitudinal variance of a fibre's lobe behind a light of this sharpness: v + 1 / sharpness for narrow ones.
STRANDLIGHT_FN float hairWidenedVariance(float variance, float sharpness)
{
    float mean = sgMeanLength(1.0f / variance) * sgMeanLength(sharpness);
    return 1.0f / max(sgSharpnessFromMeanLength(mean), 1e-3f);
}

// How sharp the light is about the fibre where a longitudinal lobe of this variance looks at it.
STRANDLIGHT_FN float hairAzimuthSharpness(HairAngles a, float variance, float sharpness)
{
    float own = 1.0f / variance;
    float cosI = (sharpness * a.cosI + own * a.cosO) / (sharpness + own);
    return sharpness * a.cosI * cosI;
}

// Radiance towards `view` under the SG's light when all of it is one unit: hairScatter's mean over the lobe. At the
// highest sharpness it is hairScatter, at 0 the albedo over 4 pi. `axis` points at the light.
STRANDLIGHT_FN vec3 hairScatterLobe(vec3 tangent, vec3 axis, float sharpness, vec3 view, vec3 color, float roughness,
                                    float tilt)
{
    HairAngles a = hairAngles(tangent, axis, view);
    float own = hairVariance(roughness);
    vec3 variance = vec3(own, 0.25f * own, 4.0f * own);
    vec3 around = vec3(hairAzimuthSharpness(a, variance.x, sharpness), hairAzimuthSharpness(a, variance.y, sharpness),
                       hairAzimuthSharpness(a, variance.z, sharpness));
    variance = vec3(hairWidenedVariance(variance.x, sharpness), hairWidenedVariance(variance.y, sharpness),
                    hairWidenedVariance(variance.z, sharpness));

    // R is no von Mises density: its first harmonic is kept.
    float share = vonMisesMeanLength(around.x);
    float through = vonMisesSharpness(vonMisesMeanLength(kHairSharpnessTT) * vonMisesMeanLength(around.y));
    float twice = vonMisesSharpness(vonMisesMeanLength(kHairSharpnessTRT) * vonMisesMeanLength(around.z));
    vec3 azimuth = vec3(mix(0.159154943f, 0.25f * a.cosHalfPhi, share), vonMisesDensity(through, -a.cosPhi),
                        vonMisesDensity(twice, a.cosPhi));

    // Pigment is met at the mean azimuth of light times TT.
    float k = around.y;
    float joint = k * k + kHairSharpnessTT * (kHairSharpnessTT - 2.0f * k * a.cosPhi);
    float throughCosPhi = clamp((k * a.cosPhi - kHairSharpnessTT) * inversesqrt(max(joint, 1e-6f)), -1.0f, 1.0f);
    return hairLobeSum(a, throughCosPhi, azimuth, variance, color, tilt);
}

// Light of the same kind that other fibres, in the way of a share 1 - visible, send on: all orders but the first, spread
// evenly. Each meets the same albedo and again leaves by that share, so in a white furnace white hair stays white.
STRANDLIGHT_FN vec3 hairScatterOn(vec3 color, float visible)
{
    vec3 blocked = clamp(color, vec3(0.0f), vec3(1.0f)) * (1.0f - visible);
    return color * blocked * (visible * 0.0795774715f) / max(vec3(1.0f) - blocked, vec3(1e-4f));
}

STRANDLIGHT_SHARED_END

#endif
