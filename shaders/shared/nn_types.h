// Push constants and constants that the network kernels and their callers share.
#ifndef STRANDLIGHT_SHARED_NN_TYPES_H
#define STRANDLIGHT_SHARED_NN_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Decoder of a spherical-gaussian lobe, 7 raw values: axis (3), sharpness, amplitude (3).
STRANDLIGHT_CONST(float) kSgSharpnessOffset = 2.0f;  // raw 0 is a sharpness of e^2, a lobe of about 40 degrees
STRANDLIGHT_CONST(float) kSgMinimumExponent = -15.0f;
STRANDLIGHT_CONST(float) kSgMaximumExponent = 11.5f; // sharpness 1e5: beyond it fp32 chords lose their digits
STRANDLIGHT_CONST(float) kSgTinyAxis = 1e-30f;       // an axis shorter than this has no direction

STRANDLIGHT_CONST(float) kRelativeLossFloor = 0.01f; // (radiance)^2

STRANDLIGHT_SHARED_END

#endif
