// A pinhole camera for the tracer (rays) and the rasteriser (matrix): the same pixel means the same ray in both.
#ifndef STRANDLIGHT_SHARED_CAMERA_TYPES_H
#define STRANDLIGHT_SHARED_CAMERA_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

struct CameraRays
{
    vec3 eye;    // metres
    vec3 corner; // direction through the top left corner of the picture, not normalised
    vec3 stepX;  // what one pixel to the right adds
    vec3 stepY;  // what one pixel down adds
};

// Unit direction through a point of the picture in pixels: (0, 0) is the top left corner, (0.5, 0.5) the centre of
// the first pixel.
STRANDLIGHT_FN vec3 cameraRayDirection(CameraRays camera, vec2 pixel)
{
    return normalize(camera.corner + pixel.x * camera.stepX + pixel.y * camera.stepY);
}

STRANDLIGHT_SHARED_END

#endif
