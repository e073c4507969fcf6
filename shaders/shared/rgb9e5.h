// Radiance in 32 bits: three 9-bit mantissas under one 5-bit exponent (the layout of
// E5B9G9R9_UFLOAT). Khronos Group. EXT_texture_shared_exponent. 2004 (rounding and range)
#ifndef STRANDLIGHT_SHARED_RGB9E5_H
#define STRANDLIGHT_SHARED_RGB9E5_H

#ifdef __cplusplus
#include "shaders/shared/nan_bits.h"
#else
#include "shared/nan_bits.h"
#endif

STRANDLIGHT_SHARED_BEGIN

STRANDLIGHT_CONST(float) kRgb9e5Maximum = 65408.0f; // 511/512 * 2^16

// 2^exponent for exponent in [-126, 127]; exact, unlike exp2 on some devices.
STRANDLIGHT_FN float powerOfTwo(int exponent)
{
    return uintBitsToFloat(uint(exponent + 127) << 23u);
}

// Whether packing would change more than rounding: too bright, negative or not a number.
STRANDLIGHT_FN bool rgb9e5Clamps(vec3 c)
{
    bool inside = c.x >= 0.0f && c.y >= 0.0f && c.z >= 0.0f && c.x <= kRgb9e5Maximum &&
                  c.y <= kRgb9e5Maximum && c.z <= kRgb9e5Maximum;
    return !inside || isNanByBits(c.x + c.y + c.z);
}

// One channel inside the range of the format. A NaN becomes 0; rgb9e5Clamps() is how the caller
// counts it.
STRANDLIGHT_FN float rgb9e5ClampChannel(float v)
{
    return v > 0.0f && !isNanByBits(v) ? (v < kRgb9e5Maximum ? v : kRgb9e5Maximum) : 0.0f;
}

// Rounds to nearest. Error per channel: at most half a step, max(r, g, b) / 511 or 2^-25.
STRANDLIGHT_FN uint packRgb9e5(vec3 c)
{
    float r = rgb9e5ClampChannel(c.x);
    float g = rgb9e5ClampChannel(c.y);
    float b = rgb9e5ClampChannel(c.z);
    float brightest = r > g ? (r > b ? r : b) : (g > b ? g : b);
    int exponent = int(floatBitsToUint(brightest) >> 23u) - 127; // floor(log2)
    int shared_ = (exponent < -16 ? -16 : exponent) + 16;        // 0..31
    if (floor(brightest * powerOfTwo(24 - shared_) + 0.5f) >= 512.0f)
        shared_ += 1; // rounding carried into a tenth bit
    float scale = powerOfTwo(24 - shared_);
    uint mr = uint(floor(r * scale + 0.5f));
    uint mg = uint(floor(g * scale + 0.5f));
    uint mb = uint(floor(b * scale + 0.5f));
    return mr | (mg << 9u) | (mb << 18u) | (uint(shared_) << 27u);
}

STRANDLIGHT_FN vec3 unpackRgb9e5(uint packed_)
{
    float scale = powerOfTwo(int(packed_ >> 27u) - 24);
    return vec3(float(packed_ & 511u), float((packed_ >> 9u) & 511u),
                float((packed_ >> 18u) & 511u)) *
           scale;
}

STRANDLIGHT_SHARED_END

#endif
