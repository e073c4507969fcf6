// Lat-long environments: where a direction lies in the picture, and back.
// Direction +y is row 0; -z is the middle of the picture and +x is a quarter to the right of it.
#ifndef STRANDLIGHT_SHARED_ENVIRONMENT_H
#define STRANDLIGHT_SHARED_ENVIRONMENT_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Unit direction of (u, v) in [0, 1]^2.
STRANDLIGHT_FN vec3 environmentDirection(float u, float v)
{
    float phi = (u - 0.5f) * 6.28318530717958648f;
    float theta = v * 3.14159265358979324f;
    float s = sin(theta);
    return vec3(s * sin(phi), cos(theta), -s * cos(phi));
}

// (u, v) of a direction of any length but zero. atan2 instead of acos: acos loses half the digits near the poles.
// At a pole u is 0.5.
STRANDLIGHT_FN vec2 environmentUv(vec3 d)
{
    float horizontal = sqrt(d.x * d.x + d.z * d.z);
    float phi = horizontal > 0.0f ? atan(d.x, -d.z) : 0.0f;
    return vec2(0.5f + phi * 0.159154943091895336f,
                atan(horizontal, d.y) * 0.318309886183790672f);
}

STRANDLIGHT_SHARED_END

#endif
