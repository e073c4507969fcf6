// Push constants of the sample kernels.
#ifndef STRANDLIGHT_SHARED_SAMPLE_TYPES_H
#define STRANDLIGHT_SHARED_SAMPLE_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

struct GradientPush
{
    uint width;  // pixels
    uint height; // pixels
    float gain;  // 1: red and green end at 1
};

struct SquarePush
{
    uint count; // values
};

STRANDLIGHT_SHARED_END

#endif
