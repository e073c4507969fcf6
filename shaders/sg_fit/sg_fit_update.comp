// Direct SG fit, the other half of a step: a texel gathers the gradients of its cells, adds the smoothness of its
// lobe among its neighbours and takes one Adam step. Lane = texel, row = lobe. CPU twin: sgFitUpdateReference.
// Kingma and Ba. Adam: A Method for Stochastic Optimization. 2015
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/nan_bits.h"
#include "shared/sg_fit_types.h"

layout(local_size_x = 64) in;

layout(binding = 0, r32ui) readonly uniform uimageBuffer gather;     // [4, texel] cell * 4 + corner
layout(binding = 1, r32ui) readonly uniform uimageBuffer neighbours; // [4, texel]
layout(binding = 2, r32f) readonly uniform imageBuffer scales;       // [texel]
layout(binding = 3, rgba32f) readonly uniform imageBuffer gradients; // [lobe * 2 + half, cell]
layout(binding = 4, rgba32f) readonly uniform imageBuffer before;    // [lobe * 2 + half, texel]
layout(binding = 5, rgba32f) writeonly uniform imageBuffer after;    // the same
layout(binding = 6, rgba32f) uniform imageBuffer moments1;           // the same
layout(binding = 7, rgba32f) uniform imageBuffer moments2;           // [lobe, texel]
layout(binding = 8, scalar) buffer Counters { uint skippedSteps; };  // lobes whose gradient, moments or values were not finite

layout(push_constant, scalar) uniform Push { SgFitUpdatePush push; };

void main()
{
    uint texel = gl_GlobalInvocationID.x;
    uint lobe = gl_GlobalInvocationID.y;
    if (texel >= push.texelCount) return;
    int first = int(lobe * 2u * push.texelCount + texel); // axis, ln sharpness
    int second = first + int(push.texelCount);            // amplitude
    float scale = abs(imageLoad(scales, int(texel)).x);
    vec4 shape = imageLoad(before, first);
    vec4 amplitudeDropped = imageLoad(before, second);
    vec3 amplitude = amplitudeDropped.xyz;
    vec3 axis = shape.xyz;
    if (amplitudeDropped.w != 0.0) {
        imageStore(after, first, shape);
        imageStore(after, second, amplitudeDropped);
        return;
    }

    // The texel's share in the gradient of each of its cells.
    vec4 dShape = vec4(0.0);
    vec3 dAmplitude = vec3(0.0);
    [[unroll]] for (uint slot = 0u; slot < 4u; ++slot) {
        uint entry = imageLoad(gather, int(slot * push.texelCount + texel)).x;
        if (entry != kSgFitNone) {
            uint cell = entry >> 2u;
            float weight = sgFitCornerWeight(sgFitPosition(cell, push.step, push.seed, push.cornerFraction), entry & 3u);
            int index = int(lobe * 2u * push.cellCount + cell);
            dShape += weight * imageLoad(gradients, index);
            dAmplitude += weight * imageLoad(gradients, index + int(push.cellCount)).xyz;
        }
    }
    dAmplitude *= scale; // the parameter that Adam sees is amplitude / scale

    // Smoothness: half the squared difference to each neighbour that has the lobe.
    [[unroll]] for (uint slot = 0u; slot < 4u; ++slot) {
        uint other = imageLoad(neighbours, int(slot * push.texelCount + texel)).x;
        if (other != kSgFitNone) {
            float both = 0.5 * (scale + abs(imageLoad(scales, int(other)).x));
            int index = int(lobe * 2u * push.texelCount + other);
            vec4 otherAmplitude = imageLoad(before, index + int(push.texelCount));
            float smoothness = otherAmplitude.w == 0.0 ? push.smoothness : 0.0;
            dShape += smoothness * vec4(vec3(kSgFitSmoothAxis), kSgFitSmoothSharpness) *
                      (shape - imageLoad(before, index));
            dAmplitude += smoothness * kSgFitSmoothAmplitude / both * (amplitude - otherAmplitude.xyz);
        }
    }
    dShape.xyz -= axis * dot(axis, dShape.xyz);

    // Adam, one second moment per group.
    vec3 squared = vec3(dot(dShape.xyz, dShape.xyz) * 0.5, // two degrees of freedom
                        dShape.w * dShape.w, dot(dAmplitude, dAmplitude) * (1.0 / 3.0));
    int group = int(lobe * push.texelCount + texel);
    vec3 v = kSgFitBeta2 * imageLoad(moments2, group).xyz + (1.0 - kSgFitBeta2) * squared;
    vec4 mShape = kSgFitBeta1 * imageLoad(moments1, first) + (1.0 - kSgFitBeta1) * dShape;
    vec3 mAmplitude = kSgFitBeta1 * imageLoad(moments1, second).xyz + (1.0 - kSgFitBeta1) * dAmplitude;
    // Also what the step starts from: max() and clamp() below would hide a NaN.
    float all = dot(v, vec3(1.0)) + dot(abs(mShape) + abs(shape), vec4(1.0)) + dot(abs(mAmplitude) + abs(amplitude), vec3(1.0));
    if (isFiniteByBits(all)) {
        imageStore(moments2, group, vec4(v, 0.0));
        imageStore(moments1, first, mShape);
        imageStore(moments1, second, vec4(mAmplitude, 0.0));

        vec3 rate = push.learningRate * push.inverseCorrection1 / (sqrt(v * push.inverseCorrection2) + kSgFitAdamEpsilon);
        float brightest = max(amplitude.x, max(amplitude.y, amplitude.z));
        shape -= vec4(vec3(rate.x), rate.y) * mShape;
        amplitude -= rate.z * (kSgFitAmplitudeBase * scale + kSgFitAmplitudeRelative * brightest) * mAmplitude;
        shape.xyz = normalize(shape.xyz); // a step is shorter than 1: never zero
        shape.w = clamp(shape.w, push.minimumLogSharpness, push.maximumLogSharpness);
        amplitude = max(amplitude, vec3(0.0)); // projected: light is not negative
    } else {
        atomicAdd(skippedSteps, 1u);
    }
    imageStore(after, first, shape);
    imageStore(after, second, vec4(amplitude, 0.0));
}
