// What the shading passes and their kernels share: push constants, and where things lie in the G-buffer.
//
// G-buffer, RGBA32F storage images at the render size:
//   position  xyz world position, w slot of the triangle (leaf order) + 1, 0 where there is sky
//   frame     xyz N of the atlas frame (towards the viewer's side), w atlas u in texels
//   tangent   xyz T of the atlas frame, w atlas v in texels
//   normal    xyz shading normal (normal map applied, bent towards the viewer), w alpha
//   diffuse   rgb, w f90
//   specular  rgb f0, w 1 where the viewer sees the back of the surface
//   emissive  rgb
#ifndef STRANDLIGHT_SHARED_SHADE_TYPES_H
#define STRANDLIGHT_SHARED_SHADE_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/camera_types.h"
#include "shaders/shared/gpu_types.h"
#else
#include "shared/camera_types.h"
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Specialisation constant values of sg_shade.comp and its neighbours.
STRANDLIGHT_CONST(uint) kSpecularNone = 0u;
STRANDLIGHT_CONST(uint) kSpecularMixture = 1u;
STRANDLIGHT_CONST(uint) kSpecularAsg = 2u;
STRANDLIGHT_CONST(uint) kSpecularNdfFilter = 3u;

STRANDLIGHT_CONST(uint) kDiffuseTokuyoshi = 0u;
STRANDLIGHT_CONST(uint) kDiffuseHill = 1u;
STRANDLIGHT_CONST(uint) kDiffuseWang = 2u;

STRANDLIGHT_CONST(uint) kViewFinal = 0u;
STRANDLIGHT_CONST(uint) kViewDiffuse = 1u;
STRANDLIGHT_CONST(uint) kViewSpecular = 2u;
STRANDLIGHT_CONST(uint) kViewLobes = 3u; // the light field itself, seen in a perfect mirror
STRANDLIGHT_CONST(uint) kViewAtlas = 4u; // atlas texels as a coloured checkerboard
STRANDLIGHT_CONST(uint) kViewCount = 5u; // how many lobes shading loops over

STRANDLIGHT_CONST(uint) kNoTexel = 0xffffffffu;

struct SgShadePush
{
    vec3 eye;
    uint width;
    uint height;
    uint atlasResolution;
};

// The radiance pyramid of the environment and its GGX-prefiltered levels, rgba32f texel buffers.
struct EnvironmentShape
{
    uint width;  // of pyramid level 0
    uint height;
    uint levels; // each half the size of the one before, stored one after the other
};

// Prefiltered level i holds the mean radiance over normalised SGs of ln(1 + sharpness) = i * kPrefilterStep; sharper
// lobes are looked up in the pyramid.
STRANDLIGHT_CONST(uint) kPrefilterLevels = 8u;
STRANDLIGHT_CONST(float) kPrefilterStep = 0.85f; // the last level has sharpness 383: 3 degrees, a texel of the level
STRANDLIGHT_CONST(uint) kPrefilterWidth = 128u;
STRANDLIGHT_CONST(uint) kPrefilterHeight = 64u;
STRANDLIGHT_CONST(uint) kPrefilterSamples = 96u;

struct PrefilterPush
{
    EnvironmentShape environment;
};

struct SgEnvironmentPush
{
    vec3 eye;
    uint width;
    uint height;
    uint atlasResolution;
    EnvironmentShape environment;
};

struct SkyPush
{
    CameraRays camera;
    uint width;
    uint height;
    EnvironmentShape environment;
};

struct DownsamplePush
{
    uint width;  // of the result
    uint height;
    uint factor; // source pixels per result pixel and axis
};

struct TonemapPush
{
    float exposure; // factor on linear radiance
    uint width;
    uint height;
};

STRANDLIGHT_SHARED_END

#endif
