// Light scattered by one hair fibre: R, TT and TRT. Longitudinal: d'Eon et al. An Energy-Conserving Hair Reflectance
// Model. 2011, with the roughness of Chiang et al. A Practical and Controllable Hair and Fur Model. 2016; azimuthal:
// Karis. Physically Based Hair Shading in Unreal. 2016, each lobe normalised.
// The fibre runs along the tangent; angles are measured from its normal plane, so sin(theta) = dot(tangent, direction).
// Weights are taken at the view's angle alone, so the three lobes share out one unit of energy exactly.
#ifndef STRANDLIGHT_SHARED_HAIR_BSDF_H
#define STRANDLIGHT_SHARED_HAIR_BSDF_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

STRANDLIGHT_CONST(float) kHairF0 = 0.046520569f; // ((1 - 1.55) / (1 + 1.55))^2
// Azimuthal lobes exp(k (cos(phi) - 1)), about the far and the near side.
STRANDLIGHT_CONST(float) kHairSharpnessTT = 3.65f;
STRANDLIGHT_CONST(float) kHairSharpnessTRT = 17.0f;
// 1 / integral over 2 pi.
STRANDLIGHT_CONST(float) kHairNormTT = 0.73114621f;
STRANDLIGHT_CONST(float) kHairNormTRT = 1.63245382f;

// log(I0(x) exp(-x)), I0 the modified Bessel function. Abramowitz, Stegun. Handbook of Mathematical Functions. 1964
// (9.8.1, 9.8.2)
STRANDLIGHT_FN float hairLogBesselI0(float x)
{
    if (x < 3.75f) {
        float t = (x / 3.75f) * (x / 3.75f);
        return log(1.0f + t * (3.5156229f + t * (3.0899424f + t * (1.2067492f +
                   t * (0.2659732f + t * (0.0360768f + t * 0.0045813f)))))) - x;
    }
    float u = 3.75f / x;
    float p = 0.39894228f + u * (0.01328592f + u * (0.00225319f + u * (-0.00157565f + u * (0.00916281f +
              u * (-0.02057706f + u * (0.02635537f + u * (-0.01647633f + u * 0.00392377f)))))));
    return log(p) - 0.5f * log(x);
}

// Longitudinal density with the cosine of the incident angle in it: its integral over cos(theta_i) d(theta_i) is 1.
// Its exponents (I0, the angles, the norm) each reach 3000 for small variances and cancel. Joined by hand they are
// (cos(theta_i + theta_o) - 1) / v, written as half the squared chord, which keeps its digits.
STRANDLIGHT_FN float hairLongitudinal(float sinI, float cosI, float sinO, float cosO, float variance)
{
    float chord2 = (cosI - cosO) * (cosI - cosO) + (sinI + sinO) * (sinI + sinO);
    float logNorm = log(variance * (1.0f - exp(-2.0f / variance)));
    return exp(hairLogBesselI0(cosI * cosO / variance) - 0.5f * chord2 / variance - logNorm);
}

// The part of `direction` across the fibre. Close to the fibre's own direction, direction -+ tangent is exact and small
// already; direction - tangent * dot() would leave nothing but rounding.
STRANDLIGHT_FN vec3 hairAcross(vec3 tangent, vec3 direction)
{
    vec3 difference = direction - (dot(tangent, direction) < 0.0f ? -tangent : tangent);
    return difference - tangent * dot(tangent, difference);
}

// Variance of R; TT has a quarter, TRT four times as much.
STRANDLIGHT_FN float hairVariance(float roughness)
{
    float r = clamp(roughness, 0.05f, 1.0f);
    float r2 = r * r;
    float r4 = r2 * r2;
    float r20 = r4 * r4 * r4 * r4 * r4;
    float s = 0.726f * r + 0.812f * r2 + 3.7f * r20;
    return s * s;
}

// Schlick's Fresnel term averaged over the fibre's width: cos(gamma) = c sqrt(1 - h^2), h uniform in [0, 1].
STRANDLIGHT_FN float hairMeanFresnel(float c)
{
    float s = 1.0f + c * (-3.92699082f + c * (6.66666667f + c * (-5.89048623f + c * (2.66666667f - c * 0.49087385f))));
    return kHairF0 + (1.0f - kHairF0) * clamp(s, 0.0f, 1.0f);
}

// The view's angle against one lobe's mean, which the scales tilt by `shift` (sine and cosine).
STRANDLIGHT_FN vec2 hairTilt(float sinO, float cosO, vec2 shift)
{
    float s = sinO * shift.y - cosO * shift.x;
    float c = abs(cosO * shift.y + sinO * shift.x);
    return vec2(s, c);
}

// Inclinations of light and view, and the azimuth between them.
struct HairAngles
{
    float sinI;
    float cosI;
    float sinO;
    float cosO;
    float cosPhi;
    float cosHalfPhi;
};

STRANDLIGHT_FN HairAngles hairAngles(vec3 tangent, vec3 light, vec3 view)
{
    HairAngles a;
    a.sinI = clamp(dot(tangent, light), -1.0f, 1.0f);
    a.sinO = clamp(dot(tangent, view), -1.0f, 1.0f);
    vec3 acrossI = hairAcross(tangent, light);
    vec3 acrossO = hairAcross(tangent, view);
    a.cosI = min(length(acrossI), 1.0f);
    a.cosO = min(length(acrossO), 1.0f);
    // Along the fibre there is no azimuth: any will do.
    float lengths = a.cosI * a.cosO;
    a.cosPhi = lengths > 1e-12f ? clamp(dot(acrossI, acrossO) / lengths, -1.0f, 1.0f) : 1.0f;
    // Half the sum of the two unit vectors: near phi = pi, sqrt(0.5 + 0.5 cosPhi) keeps four digits at most.
    a.cosHalfPhi = lengths > 1e-12f ? min(0.5f * length(acrossI / a.cosI + acrossO / a.cosO), 1.0f) : 1.0f;
    return a;
}

STRANDLIGHT_FN float hairCosHalf(float cosPhi)
{
    return sqrt(max(0.5f + 0.5f * cosPhi, 0.0f));
}

// The three lobes' sum. `azimuth` holds the densities of R, TT and TRT over the azimuth, `variance` their longitudinal
// widths; `throughCosPhi` is the azimuth at which the light goes through the fibre.
STRANDLIGHT_FN vec3 hairLobeSum(HairAngles a, float throughCosPhi, vec3 azimuth, vec3 variance, vec3 color, float tilt)
{
    float cosD = max(a.cosO, 1e-2f);
    float fresnel = hairMeanFresnel(cosD);
    vec3 base = clamp(color, vec3(1e-5f), vec3(1.0f));
    // Offset of the ray that leaves through the fibre, and how much pigment it meets (Karis).
    float bend = 1.0f / (1.19f / cosD + 0.36f * cosD);
    float h = clamp((1.0f + bend * (0.6f - 0.8f * throughCosPhi)) * hairCosHalf(throughCosPhi), 0.0f, 1.0f);
    float inside = sqrt(max(1.0f - h * h * bend * bend, 0.0f));
    vec3 throughOnce = pow(base, vec3(inside / (2.0f * cosD)));
    vec3 throughTwice = pow(base, vec3(0.8f / cosD));

    float st = sin(tilt);
    float ct = cos(tilt);
    float s2 = 2.0f * st * ct;
    float c2 = ct * ct - st * st;
    vec2 r = hairTilt(a.sinO, a.cosO, vec2(-s2, c2));                                 // -2 tilt
    vec2 tt = hairTilt(a.sinO, a.cosO, vec2(st, ct));                                 // + tilt
    vec2 trt = hairTilt(a.sinO, a.cosO, vec2(2.0f * s2 * c2, c2 * c2 - s2 * s2));     // + 4 tilt

    vec3 sum = vec3(fresnel * azimuth.x * hairLongitudinal(a.sinI, a.cosI, r.x, r.y, variance.x));
    float through = (1.0f - fresnel) * (1.0f - fresnel);
    sum += throughOnce * (through * azimuth.y * hairLongitudinal(a.sinI, a.cosI, tt.x, tt.y, variance.y));
    // TRT and all higher orders: a geometric series in fresnel.
    sum += throughTwice * ((1.0f - fresnel) * fresnel * azimuth.z *
                           hairLongitudinal(a.sinI, a.cosI, trt.x, trt.y, variance.z));
    return sum;
}

// Radiance towards `view` for unit irradiance on a plane facing `light` (both unit, away from the fibre): the cosine
// is included. `color` is the reflectance in [0, 1], tilt in radians.
STRANDLIGHT_FN vec3 hairScatter(vec3 tangent, vec3 light, vec3 view, vec3 color, float roughness, float tilt)
{
    HairAngles a = hairAngles(tangent, light, view);
    vec3 azimuth = vec3(0.25f * a.cosHalfPhi, kHairNormTT * exp(-kHairSharpnessTT * (a.cosPhi + 1.0f)),
                        kHairNormTRT * exp(kHairSharpnessTRT * (a.cosPhi - 1.0f)));
    float variance = hairVariance(roughness);
    return hairLobeSum(a, a.cosPhi, azimuth, vec3(variance, 0.25f * variance, 4.0f * variance), color, tilt);
}

// Light that reaches the fibre by way of others: Karis's stand-in, a wrapped diffuse term about the fibre's side that
// faces the viewer, tinted where more fibres were in the way. For unit irradiance before shadowing.
STRANDLIGHT_FN vec3 hairMultipleScatter(vec3 tangent, vec3 light, vec3 view, vec3 color, float shadow)
{
    vec3 across = hairAcross(tangent, view);
    float size = length(across);
    vec3 normal = size > 1e-4f ? across / size : view;
    float wrapped = clamp((dot(normal, light) + 1.0f) * 0.25f, 0.0f, 1.0f);
    vec3 base = clamp(color, vec3(1e-5f), vec3(1.0f));
    float luminance = dot(base, vec3(0.2126f, 0.7152f, 0.0722f));
    vec3 tint = pow(base / luminance, vec3(1.0f - clamp(shadow, 0.0f, 1.0f)));
    return sqrt(base) * tint * (wrapped * 0.31830989f * shadow);
}

STRANDLIGHT_SHARED_END

#endif
