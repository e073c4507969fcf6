// Error function and its complement in fp32; GLSL has neither.
// Chebyshev fits of our own: erf(x) / x in x^2 on [0, 1] (1.2e-9), erfc(x) exp(x^2) / t in t = 2 / (2 + x) beyond (5e-8).
// The complement is never formed as 1 - erf where that would cancel.
#ifndef STRANDLIGHT_SHARED_ERF_H
#define STRANDLIGHT_SHARED_ERF_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// erf(x) for |x| <= 1.
STRANDLIGHT_FN float errorFunctionCentre(float x)
{
    float q = x * x;
    float p = 7.8758750627e-5f;
    p = p * q - 8.0168642872e-4f;
    p = p * q + 5.1890874234e-3f;
    p = p * q - 2.6854212011e-2f;
    p = p * q + 0.11283594715f;
    p = p * q - 0.37612626667f;
    p = p * q + 1.1283791658f;
    return x * p;
}

// erfc(x) for x >= 1. Underflows to zero near x = 9.3, as it should.
STRANDLIGHT_FN float errorFunctionTail(float x)
{
    float t = 2.0f / (2.0f + x);
    float p = 0.093921017608f;
    p = p * t - 0.22824586576f;
    p = p * t + 0.085986651032f;
    p = p * t + 0.057800971688f;
    p = p * t + 0.18039672116f;
    p = p * t + 0.24651042849f;
    p = p * t + 0.28210471533f;
    p = p * t + 0.28209474041f;
    return exp(-x * x) * t * p;
}

STRANDLIGHT_FN float errorFunction(float x)
{
    if (abs(x) <= 1.0f) {
        return errorFunctionCentre(x);
    }
    float tail = 1.0f - errorFunctionTail(abs(x));
    return x < 0.0f ? -tail : tail;
}

STRANDLIGHT_FN float errorFunctionComplement(float x)
{
    if (abs(x) <= 1.0f) {
        return 1.0f - errorFunctionCentre(x);
    }
    float tail = errorFunctionTail(abs(x));
    return x < 0.0f ? 2.0f - tail : tail;
}

STRANDLIGHT_SHARED_END

#endif
