// The decoder of a spherical-gaussian lobe; the twin is compute_nn/reference/sg_mixture.hpp.
#ifndef STRANDLIGHT_NN_SG_LOBE_GLSL
#define STRANDLIGHT_NN_SG_LOBE_GLSL

#include "shared/nn_types.h"
#include "nn/nn_math.glsl"

// Length of the raw axis, scaled so that nothing squares out of range; 0: no direction. NaN stays NaN.
float rawAxisLength(vec3 raw)
{
    vec3 a = abs(raw);
    float largest = a.x > a.y ? a.x : a.y;
    largest = largest > a.z ? largest : a.z;
    vec3 scaled = raw / largest;
    float length3 = largest * sqrt(dot(scaled, scaled));
    bool poisoned = isnan(raw.x) || isnan(raw.y) || isnan(raw.z);
    return poisoned ? uintBitsToFloat(0x7fc00000u) : (largest <= kSgTinyAxis ? 0.0 : length3);
}

vec3 decodeAxis(vec3 raw, float rawLength)
{
    if (rawLength > 1e38) { // which may be infinite for finite components
        vec3 scaled = raw * 1e-20;
        return scaled / length(scaled);
    }
    return rawLength == 0.0 ? vec3(0.0, 0.0, 1.0) : raw / rawLength;
}

float decodeSharpness(float raw)
{
    float exponent = raw + kSgSharpnessOffset;
    exponent = exponent < kSgMinimumExponent ? kSgMinimumExponent : exponent;
    exponent = exponent > kSgMaximumExponent ? kSgMaximumExponent : exponent;
    return nnExp(exponent);
}

// 0 where the exponent is clamped.
float decodeSharpnessDerivative(float raw, float sharpness)
{
    float exponent = raw + kSgSharpnessOffset;
    return exponent < kSgMinimumExponent || exponent > kSgMaximumExponent ? 0.0 : sharpness;
}

#endif
