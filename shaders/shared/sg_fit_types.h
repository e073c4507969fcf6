// What the kernels of the direct SG fit and their CPU twin (passes/sg_fit_reference.cpp) share.
// The fit: Adam over the parameters of all texels at once. A cell is a 2 x 2 block of atlas texels; each step looks at
// one bilinear position per cell and a stratified subset of directions.
#ifndef STRANDLIGHT_SHARED_SG_FIT_TYPES_H
#define STRANDLIGHT_SHARED_SG_FIT_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#include "shaders/shared/rng.h"
#else
#include "shared/gpu_types.h"
#include "shared/rng.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// A lobe is two vec4, so that a lane fetches it with two loads: (axis, ln lambda) and (amplitude, dropped).
// Blocks are [lobe * 2 + half, item] vec4, item = texel or cell; component c of a lobe is component c % 4 of half c / 4.
STRANDLIGHT_CONST(uint) kSgFitAxis = 0u;      // 3: unit axis in the texel's frame
STRANDLIGHT_CONST(uint) kSgFitSharpness = 3u; // 1: ln(lambda)
STRANDLIGHT_CONST(uint) kSgFitAmplitude = 4u; // 3: radiance
STRANDLIGHT_CONST(uint) kSgFitComponents = 7u;
STRANDLIGHT_CONST(uint) kSgFitDropped = 7u;   // 1: the texel does without this lobe, which stays as it is; else 0
STRANDLIGHT_CONST(uint) kSgFitLobeFloats = 8u;
// Adam keeps one second moment per group (axis, sharpness, amplitude), so that a step neither turns with the
// coordinate axes nor changes hue: [lobe, texel] vec4 (axis, sharpness, amplitude, 0).
STRANDLIGHT_CONST(uint) kSgFitGroups = 3u;
STRANDLIGHT_CONST(uint) kSgFitMomentFloats = 4u;

// Index of a float in a block of lobes.
STRANDLIGHT_FN uint sgFitIndex(uint lobe, uint component, uint item, uint itemCount)
{
    return ((lobe * 2u + component / 4u) * itemCount + item) * 4u + component % 4u;
}

STRANDLIGHT_CONST(uint) kSgFitNone = 0xffffffffu;

// Amplitudes differ by orders of magnitude between lobes and texels. Their Adam step is learning rate x
// (kSgFitAmplitudeBase * mean radiance of the texel + kSgFitAmplitudeRelative * the lobe's brightest channel).
// Measured on the synthetic room at 1x, 20x and 1000x lamps: the relative term cuts the texel error by up to 25 %.
STRANDLIGHT_CONST(float) kSgFitAmplitudeBase = 3.0f;
STRANDLIGHT_CONST(float) kSgFitAmplitudeRelative = 2.0f;

// Weights of the Laplacian on axis, ln sharpness and (amplitude / mean radiance).
STRANDLIGHT_CONST(float) kSgFitSmoothAxis = 1.0f;
STRANDLIGHT_CONST(float) kSgFitSmoothSharpness = 0.1f;
STRANDLIGHT_CONST(float) kSgFitSmoothAmplitude = 0.02f;

STRANDLIGHT_CONST(float) kSgFitBeta1 = 0.9f;
STRANDLIGHT_CONST(float) kSgFitBeta2 = 0.99f;
STRANDLIGHT_CONST(float) kSgFitAdamEpsilon = 1.0e-12f;

// Shorter interpolated axes (opposed corners) are not trusted: their gradient is scaled as if they were this long.
STRANDLIGHT_CONST(float) kSgFitShortestAxis = 1.0e-3f;

// One chunk of cells, one step.
struct SgFitCellPush
{
    uint texelCount;
    uint cellCount;       // of all chunks: the plane size of corners and gradients
    uint firstCell;       // of this chunk
    uint chunkCells;
    uint firstTexel;      // of the images of this chunk
    uint imageTexels;     // plane size of the images of this chunk
    uint directionCount;
    uint directionsPerStep; // divides directionCount
    uint step;            // from 0
    uint seed;
    float cornerFraction; // probability that the position is a texel
    float peakSoftening;  // weight of a direction: 1 / (1 + peakSoftening * target / mean)
};

// All texels, one step.
struct SgFitUpdatePush
{
    uint texelCount;
    uint cellCount;
    uint step;
    uint seed;
    float cornerFraction;
    float smoothness;
    float learningRate;        // of this step
    float inverseCorrection1;  // 1 / (1 - beta1^t)
    float inverseCorrection2;
    float minimumLogSharpness;
    float maximumLogSharpness;
};

// Where in its cell the step looks: (0,0) is corner 0, (1,0) corner 1, (0,1) corner 2.
STRANDLIGHT_FN vec2 sgFitPosition(uint cell, uint step, uint seed, float cornerFraction)
{
    vec3 r = uniform3(cell, step, 0u, seed);
    if (r.z < cornerFraction) {
        return vec2(r.x < 0.5f ? 0.0f : 1.0f, r.y < 0.5f ? 0.0f : 1.0f);
    }
    return vec2(r.x, r.y);
}

STRANDLIGHT_FN float sgFitCornerWeight(vec2 position, uint corner)
{
    float x = (corner & 1u) != 0u ? position.x : 1.0f - position.x;
    float y = (corner & 2u) != 0u ? position.y : 1.0f - position.y;
    return x * y;
}

// Sample `k` of a step: one direction of each stratum, and every direction once in directionCount /
// directionsPerStep steps.
STRANDLIGHT_FN uint sgFitDirection(uint k, uint step, uint directionsPerStep, uint directionCount, uint seed)
{
    uint stride = directionCount / directionsPerStep;
    uint phase = hashPcg(k ^ hashPcg(step / stride + seed));
    return k * stride + (phase % stride + step) % stride;
}

STRANDLIGHT_SHARED_END

#endif
