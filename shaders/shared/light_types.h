// Light sampling as the path tracer reads it.
#ifndef STRANDLIGHT_SHARED_LIGHT_TYPES_H
#define STRANDLIGHT_SHARED_LIGHT_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Light table, words of 4: [0] = (entries, probability of choosing the environment as float bits, grid width, grid
// height), [1] = (environment width, height, 0, 0), then the entries of EmitterTable (engine/scene/emitters.hpp).
STRANDLIGHT_CONST(uint) kLightTableHeader = 2u;
STRANDLIGHT_CONST(uint) kPunctualBit = 0x80000000u;

// What a scene has; a specialisation constant of every kernel that traces, so that the rest is not even compiled.
STRANDLIGHT_CONST(uint) kFeatureEmitters = 1u;     // emissive triangles or punctual lights
STRANDLIGHT_CONST(uint) kFeaturePunctual = 2u;
STRANDLIGHT_CONST(uint) kFeatureEnvironment = 4u;
STRANDLIGHT_CONST(uint) kFeatureAlphaMask = 8u;
STRANDLIGHT_CONST(uint) kFeatureBaseColorTexture = 16u;
STRANDLIGHT_CONST(uint) kFeatureMetallicRoughnessTexture = 32u;
STRANDLIGHT_CONST(uint) kFeatureNormalTexture = 64u;
STRANDLIGHT_CONST(uint) kFeatureEmissiveTexture = 128u;
STRANDLIGHT_CONST(uint) kFeatureTexCoord1 = 256u;  // some texture uses the second set
STRANDLIGHT_CONST(uint) kFeatureLayer = 512u;      // some surface is not pure Lambert

// Corner attributes, 3 x 4 words per triangle in leaf order: (normal, u0, v0, tangent), directions as packDirection;
// the tangent's lowest bit is set for handedness -1. With kFeatureTexCoord1, 2 x 4 words per triangle follow after
// all triangles: (u1, v1) of corners 0 and 1, then of corner 2.

STRANDLIGHT_SHARED_END

#endif
