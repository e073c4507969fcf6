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

// Where a light field image is taken: 4 texels of rgba32f each.
struct CapturePoint
{
    vec3 position;
    float padding0;
    vec3 tangent;   // the image's x
    float padding1;
    vec3 normal;    // the image's z
    float padding2;
    vec3 geometric; // normal of the surface itself; directions below it see nothing
    float padding3;
};

struct CapturePush
{
    BvhGrid grid;
    uint triangleCount;
    uint firstTexel; // of the slice
    uint firstCell;  // of this dispatch, within the slice: texel * size^2 + cell
    uint cellCount;  // of this dispatch
    uint size;       // cells per side
    uint samples;    // per cell
    uint seed;
    uint bounces;
};

struct CapturePackPush
{
    uint cellCount;  // of the slice
    uint firstWord;  // where the slice starts in the light field's part
    uint samples;
    uint environment; // 1: write the environment image too
};

// What primary rays met, counted per texel of the slice: front faces, backs of single-sided materials, backs of
// double-sided ones, nothing.
STRANDLIGHT_CONST(uint) kPrimaryKinds = 4u;

// Counters of the tracing kernels: [0] items of the dispatch that are not finished, [1] rays and paths given up,
// [2] samples that were not finite and were left out.
STRANDLIGHT_CONST(uint) kTraceCounters = 4u;

STRANDLIGHT_SHARED_END

#endif
