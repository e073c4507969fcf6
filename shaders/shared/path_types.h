// Push constants of the path tracing kernels.
#ifndef STRANDLIGHT_SHARED_PATH_TYPES_H
#define STRANDLIGHT_SHARED_PATH_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/camera_types.h"
#include "shaders/shared/trace_types.h"
#else
#include "shared/camera_types.h"
#include "shared/trace_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

struct PathTracePush
{
    BvhGrid grid;
    CameraRays camera;
    uint triangleCount;
    uint width;        // of the picture, pixels
    uint firstPixel;   // of this dispatch, row-major
    uint pixelCount;
    uint targetSample; // pixels are done when they have this many samples
    uint seed;
    uint bounces;
};

struct CapturePush
{
    BvhGrid grid;
    uint triangleCount;
    uint firstCell;    // of this dispatch, within the slice: texel * size^2 + cell
    uint cellCount;
    uint sliceTexel;   // first texel of the slice
    uint size;         // cells per side
    uint samples;      // per cell
    uint seed;
    uint bounces;
};

// Counters of the tracing kernels: [0] items of the dispatch that are not finished, [1] rays and paths given up,
// [2] samples that were not finite and were left out.
STRANDLIGHT_CONST(uint) kTraceCounters = 4u;

STRANDLIGHT_SHARED_END

#endif
