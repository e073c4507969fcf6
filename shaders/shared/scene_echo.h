// The scene functions of a query as a row of floats: shaders/scene/scene_echo.comp fills it on the device and
// tests/gpu/test_scene_functions.cpp in C++; both must mean the same.
#ifndef STRANDLIGHT_SHARED_SCENE_ECHO_H
#define STRANDLIGHT_SHARED_SCENE_ECHO_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

struct SceneEchoQuery
{
    vec2 uv0;
    vec2 uv1;
    float lod;      // log2 of the footprint in texture coordinates
    uint material;
    vec3 direction; // for the environment mapping and the camera
    vec3 point;     // for the light
    uint light;
};

struct SceneEcho
{
    vec4 baseColor; // w: alpha
    vec3 emissive;
    float metallic;
    vec3 normal;
    float roughness;
    vec3 specular;   // specularColor * specular
    float flags;     // 1 double sided + 2 alpha cutoff >= 0
    vec2 environmentUv;
    vec3 environmentDirection; // of environmentUv
    vec3 irradiance;
    float lightDistance;
    float maskAlpha; // evaluateAlpha
};
STRANDLIGHT_CONST(uint) kSceneEchoFloats = 26u;

struct SceneEchoPush
{
    uint count;
};

STRANDLIGHT_SHARED_END

#endif
