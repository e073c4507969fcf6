// The decoder of a spherical-gaussian lobe; the twin is compute_nn/reference/sg_mixture.hpp.
#ifndef STRANDLIGHT_NN_SG_LOBE_GLSL
#define STRANDLIGHT_NN_SG_LOBE_GLSL

#include "shared/nn_types.h"
#include "nn/nn_math.glsl"

const float kSgAxisUp = 1180591620717411303424.0; // 2^70
const float kSgAxisDown = 1.0 / kSgAxisUp;

// Length of the raw axis, scaled so that nothing squares out of range; 0: no direction. NaN stays NaN.
float rawAxisLength(vec3 raw)
{
    vec3 a = abs(raw);
    float largest = a.x > a.y ? a.x : a.y;
    largest = largest > a.z ? largest : a.z;
    // By powers of two, not by `largest`: beyond 2^126 a reciprocal is denormal, which a device may make zero.
    bool huge = largest > 1e18;
    float scale = huge ? kSgAxisDown : (largest < 1e-18 ? kSgAxisUp : 1.0);
    float unscale = huge ? kSgAxisUp : (largest < 1e-18 ? kSgAxisDown : 1.0);
    vec3 scaled = raw * scale;
    float length3 = unscale * sqrt(dot(scaled, scaled));
    bool poisoned = isNanByBits(raw.x) || isNanByBits(raw.y) || isNanByBits(raw.z);
    return poisoned ? uintBitsToFloat(0x7fc00000u) : (largest <= kSgTinyAxis ? 0.0 : length3);
}

vec3 decodeAxis(vec3 raw, float rawLength)
{
    if (rawLength > 1e18) { // which may be infinite for finite components
        vec3 scaled = raw * kSgAxisDown;
        return scaled / length(scaled);
    }
    return rawLength == 0.0 ? vec3(0.0, 0.0, 1.0) : raw / rawLength;
}

float decodeSharpness(float raw)
{
    float exponent = raw + kSgSharpnessOffset;
    exponent = exponent < kSgMinimumExponent ? kSgMinimumExponent : exponent;
    exponent = exponent > kSgMaximumExponent ? kSgMaximumExponent : exponent;
    return nnExp(keepNan(raw, exponent));
}

// 0 where the exponent is clamped.
float decodeSharpnessDerivative(float raw, float sharpness)
{
    float exponent = raw + kSgSharpnessOffset;
    return exponent < kSgMinimumExponent || exponent > kSgMaximumExponent ? 0.0 : sharpness;
}

#endif
