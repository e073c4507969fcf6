// Push constants of the G-buffer passes.
#ifndef STRANDLIGHT_SHARED_GBUFFER_TYPES_H
#define STRANDLIGHT_SHARED_GBUFFER_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/camera_types.h"
#else
#include "shared/camera_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

struct VisibilityPush
{
    mat4 viewProjection; // world to Vulkan clip space
    uint triangleCount;
};

struct SurfacesPush
{
    CameraRays camera;
    uint width;
    uint height;
    uint triangleCount;
    float emission; // factor: 1, or 0 where a view leaves emission out
};

STRANDLIGHT_SHARED_END

#endif
