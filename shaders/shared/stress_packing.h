// Integer-valued functions under stress: packing and sample masks (passes/stress). Not part of stress_functions.h,
// because bits have no double counterpart.
#ifndef STRANDLIGHT_SHARED_STRESS_PACKING_H
#define STRANDLIGHT_SHARED_STRESS_PACKING_H

#ifdef __cplusplus
#include "shaders/shared/hair_masks.h"
#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/stress_functions.h"
#else
#include "shared/hair_masks.h"
#include "shared/rgb9e5.h"
#include "shared/stress_functions.h"
#endif

STRANDLIGHT_SHARED_BEGIN

STRANDLIGHT_CONST(uint) kStressRgb9e5 = 100u;   // a.xyz -> unpacked; clamps, word in two halves
STRANDLIGHT_CONST(uint) kStressHairMask = 101u; // a.x: alpha, a.yzw: counter -> mask

STRANDLIGHT_FN StressOutput stressPacking(uint function, StressInput item)
{
    StressOutput result;
    if (function == kStressRgb9e5) {
        vec3 color = vec3(item.a.x, item.a.y, item.a.z);
        uint word = packRgb9e5(color);
        vec3 back = unpackRgb9e5(word);
        result.x = vec4(back.x, back.y, back.z, rgb9e5Clamps(color) ? 1.0f : 0.0f);
        result.y = vec4(float(word >> 16u), float(word & 0xffffu), 0.0f, 0.0f);
    } else {
        uvec3 bits = hairFragmentBits(uint(item.a.y), uint(item.a.z), uint(item.a.w), 0u, 0u);
        result.x = vec4(float(hairSampleMask(item.a.x, bits)), 0.0f, 0.0f, 0.0f);
        result.y = vec4(0.0f);
    }
    return result;
}

STRANDLIGHT_SHARED_END

#endif
