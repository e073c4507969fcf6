// Direct SG fit, the other half of a step: a texel gathers the gradients of its cells, adds the smoothness of its
// lobe among its neighbours and takes one Adam step. Lane = texel, row = lobe. CPU twin: sgFitUpdateReference.
// Kingma and Ba. Adam: A Method for Stochastic Optimization. 2015
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/sg_fit_types.h"

layout(local_size_x = 64) in;

layout(binding = 0, r32ui) readonly uniform uimageBuffer gather;     // [4, texel] cell * 4 + corner
layout(binding = 1, r32ui) readonly uniform uimageBuffer neighbours; // [4, texel]
layout(binding = 2, r32f) readonly uniform imageBuffer scales;       // [texel]
layout(binding = 3, r32f) readonly uniform imageBuffer gradients;    // [lobe * 7 + component, cell]
layout(binding = 4, r32f) readonly uniform imageBuffer before;       // [lobe * 7 + component, texel]
layout(binding = 5, r32f) writeonly uniform imageBuffer after;       // the same
layout(binding = 6, r32f) uniform imageBuffer moments1;              // the same
layout(binding = 7, r32f) uniform imageBuffer moments2;              // [lobe * 3 + group, texel]
layout(binding = 8, scalar) buffer Counters { uint skippedSteps; };  // lobes whose gradient was not finite

layout(push_constant, scalar) uniform Push { SgFitUpdatePush push; };

vec3 axisOf(uint plane, uint texel)
{
    return vec3(imageLoad(before, int(plane + texel)).x, imageLoad(before, int(plane + push.texelCount + texel)).x,
                imageLoad(before, int(plane + 2u * push.texelCount + texel)).x);
}

float sharpnessOf(uint plane, uint texel)
{
    return imageLoad(before, int(plane + kSgFitSharpness * push.texelCount + texel)).x;
}

vec3 amplitudeOf(uint plane, uint texel)
{
    return axisOf(plane + kSgFitAmplitude * push.texelCount, texel);
}

// One moment plane: returns the bias-corrected first moment.
float updateFirstMoment(uint plane, uint texel, float gradient)
{
    int index = int(plane + texel);
    float m = kSgFitBeta1 * imageLoad(moments1, index).x + (1.0 - kSgFitBeta1) * gradient;
    imageStore(moments1, index, vec4(m));
    return m * push.inverseCorrection1;
}

// Returns 1 / sqrt of the bias-corrected second moment of a group, whose mean squared gradient is given.
float updateSecondMoment(uint group, uint texel, float squared)
{
    int index = int(group * push.texelCount + texel);
    float v = kSgFitBeta2 * imageLoad(moments2, index).x + (1.0 - kSgFitBeta2) * squared;
    imageStore(moments2, index, vec4(v));
    return 1.0 / (sqrt(v * push.inverseCorrection2) + kSgFitAdamEpsilon);
}

void storeAfter(uint plane, uint texel, float value)
{
    imageStore(after, int(plane + texel), vec4(value));
}

bool isFinite(float value)
{
    return !isnan(value) && !isinf(value);
}

void main()
{
    uint texel = gl_GlobalInvocationID.x;
    uint lobe = gl_GlobalInvocationID.y;
    if (texel >= push.texelCount) return;
    uint plane = lobe * kSgFitComponents * push.texelCount;
    float scale = abs(imageLoad(scales, int(texel)).x);
    vec3 axis = axisOf(plane, texel);
    float logSharpness = sharpnessOf(plane, texel);
    vec3 amplitude = amplitudeOf(plane, texel);

    // The texel's share in the gradient of each of its cells.
    vec3 dAxis = vec3(0.0);
    float dSharpness = 0.0;
    vec3 dAmplitude = vec3(0.0);
    [[unroll]] for (uint slot = 0u; slot < 4u; ++slot) {
        uint entry = imageLoad(gather, int(slot * push.texelCount + texel)).x;
        if (entry != kSgFitNone) {
            uint cell = entry >> 2u;
            float weight = sgFitCornerWeight(sgFitPosition(cell, push.step, push.seed, push.cornerFraction), entry & 3u);
            int base = int(lobe * kSgFitComponents * push.cellCount + cell);
            int stride = int(push.cellCount);
            dAxis += weight * vec3(imageLoad(gradients, base).x, imageLoad(gradients, base + stride).x,
                                   imageLoad(gradients, base + 2 * stride).x);
            dSharpness += weight * imageLoad(gradients, base + 3 * stride).x;
            dAmplitude += weight * vec3(imageLoad(gradients, base + 4 * stride).x,
                                        imageLoad(gradients, base + 5 * stride).x,
                                        imageLoad(gradients, base + 6 * stride).x);
        }
    }
    dAmplitude *= scale; // the parameter that Adam sees is amplitude / scale

    // Smoothness: half the squared difference to each neighbour.
    [[unroll]] for (uint slot = 0u; slot < 4u; ++slot) {
        uint other = imageLoad(neighbours, int(slot * push.texelCount + texel)).x;
        if (other != kSgFitNone) {
            float both = 0.5 * (scale + abs(imageLoad(scales, int(other)).x));
            dAxis += push.smoothness * kSgFitSmoothAxis * (axis - axisOf(plane, other));
            dSharpness += push.smoothness * kSgFitSmoothSharpness * (logSharpness - sharpnessOf(plane, other));
            dAmplitude += push.smoothness * kSgFitSmoothAmplitude / both * (amplitude - amplitudeOf(plane, other));
        }
    }
    dAxis -= axis * dot(axis, dAxis);

    // Adam, one second moment per group.
    float squaredAxis = dot(dAxis, dAxis) * 0.5; // two degrees of freedom
    float squaredSharpness = dSharpness * dSharpness;
    float squaredAmplitude = dot(dAmplitude, dAmplitude) * (1.0 / 3.0);
    if (isFinite(squaredAxis + squaredSharpness + squaredAmplitude)) {
        uint group = lobe * kSgFitGroups;
        uint count = push.texelCount;
        float brightest = max(amplitude.x, max(amplitude.y, amplitude.z));
        float rate = push.learningRate;
        float axisRate = rate * updateSecondMoment(group, texel, squaredAxis);
        float sharpnessRate = rate * updateSecondMoment(group + 1u, texel, squaredSharpness);
        float amplitudeRate = rate * (kSgFitAmplitudeBase * scale + kSgFitAmplitudeRelative * brightest) *
                              updateSecondMoment(group + 2u, texel, squaredAmplitude);
        axis -= axisRate * vec3(updateFirstMoment(plane, texel, dAxis.x),
                                updateFirstMoment(plane + count, texel, dAxis.y),
                                updateFirstMoment(plane + 2u * count, texel, dAxis.z));
        logSharpness -= sharpnessRate * updateFirstMoment(plane + 3u * count, texel, dSharpness);
        amplitude -= amplitudeRate * vec3(updateFirstMoment(plane + 4u * count, texel, dAmplitude.x),
                                          updateFirstMoment(plane + 5u * count, texel, dAmplitude.y),
                                          updateFirstMoment(plane + 6u * count, texel, dAmplitude.z));
        axis = normalize(axis); // a step is shorter than 1: never zero
        logSharpness = clamp(logSharpness, push.minimumLogSharpness, push.maximumLogSharpness);
        amplitude = max(amplitude, vec3(0.0)); // projected: light is not negative
    } else {
        atomicAdd(skippedSteps, 1u);
    }

    uint count = push.texelCount;
    storeAfter(plane, texel, axis.x);
    storeAfter(plane + count, texel, axis.y);
    storeAfter(plane + 2u * count, texel, axis.z);
    storeAfter(plane + 3u * count, texel, logSharpness);
    storeAfter(plane + 4u * count, texel, amplitude.x);
    storeAfter(plane + 5u * count, texel, amplitude.y);
    storeAfter(plane + 6u * count, texel, amplitude.z);
}
