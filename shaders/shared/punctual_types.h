// Push constants of direct punctual lighting.
#ifndef STRANDLIGHT_SHARED_PUNCTUAL_TYPES_H
#define STRANDLIGHT_SHARED_PUNCTUAL_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/trace_types.h"
#else
#include "shared/trace_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Lights of one dispatch: the trips of their shadow rays share lavapipe's loop budget (trace_types.h).
STRANDLIGHT_CONST(uint) kPunctualLightsPerDispatch = 4u;

struct PunctualPush
{
    BvhGrid grid;
    vec3 eye;
    uint width;
    uint height;
    uint triangleCount;
    uint firstLight;
    uint lightCount; // of this dispatch
};

STRANDLIGHT_SHARED_END

#endif
