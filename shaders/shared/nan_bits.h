// NaN and infinity by their bits. Unless a module forbids it, a device's compiler may take every float for a number:
// isnan(x) and x != x become false, x > 0 ? x : 0 becomes max(), which drops a NaN (NVIDIA's does both). Integer tests stay.
// SPIR-V's alternative, SignedZeroInfNanPreserve, is optional for devices and forbids other folding too.
#ifndef STRANDLIGHT_SHARED_NAN_BITS_H
#define STRANDLIGHT_SHARED_NAN_BITS_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

STRANDLIGHT_FN bool isNanByBits(float x)
{
    return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u;
}

STRANDLIGHT_FN bool isFiniteByBits(float x)
{
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

STRANDLIGHT_FN bool areFiniteByBits(vec3 v)
{
    return isFiniteByBits(v.x) && isFiniteByBits(v.y) && isFiniteByBits(v.z);
}

// `value`, which is x clamped or chosen by comparisons; x itself where x is NaN.
STRANDLIGHT_FN float keepNan(float x, float value)
{
    return isNanByBits(x) ? x : value;
}

STRANDLIGHT_SHARED_END

#endif
