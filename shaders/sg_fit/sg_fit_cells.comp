// Direct SG fit, half a step: loss of one cell at one bilinear position and its gradient with respect to the
// interpolated lobes. Lane = cell. CPU twin: sgFitCellsReference.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/sg_fit_types.h"
#include "shared/rgb9e5.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kLobes = 8;

layout(binding = 0, r32ui) readonly uniform uimageBuffer corners;    // [4, cell] texel
layout(binding = 1, r32ui) readonly uniform uimageBuffer images;     // [direction, texel of this chunk] RGB9E5
layout(binding = 2, rgba32f) readonly uniform imageBuffer directions; // [direction] (unit vector, share of solid angle)
layout(binding = 3, r32f) readonly uniform imageBuffer parameters;   // [lobe * 7 + component, texel]
layout(binding = 4, r32f) readonly uniform imageBuffer scales;       // [texel] mean radiance, negative: no image
layout(binding = 5, scalar) writeonly buffer Gradients { float gradients[]; }; // [lobe * 7 + component, cell]
layout(binding = 6, scalar) writeonly buffer Losses { float losses[]; };       // [cell]

layout(push_constant, scalar) uniform Push { SgFitCellPush push; };

float parameter(uint lobe, uint component, uint texel)
{
    return imageLoad(parameters, int((lobe * kSgFitComponents + component) * push.texelCount + texel)).x;
}

vec3 parameter3(uint lobe, uint component, uint texel)
{
    return vec3(parameter(lobe, component, texel), parameter(lobe, component + 1u, texel),
                parameter(lobe, component + 2u, texel));
}

void main()
{
    uint local = gl_GlobalInvocationID.x;
    if (local >= push.chunkCells) return;
    uint cell = push.firstCell + local;

    // The position, and what its four texels know.
    vec2 position = sgFitPosition(cell, push.step, push.seed, push.cornerFraction);
    uint texel[4];
    float weight[4];
    float known[4]; // share of the target
    float meanRadiance = 0.0;
    float trust = 0.0;
    [[unroll]] for (uint c = 0u; c < 4u; ++c) {
        texel[c] = imageLoad(corners, int(c * push.cellCount + cell)).x;
        weight[c] = sgFitCornerWeight(position, c);
        float scale = imageLoad(scales, int(texel[c])).x;
        meanRadiance += weight[c] * abs(scale);
        known[c] = scale > 0.0 ? weight[c] : 0.0;
        trust += known[c];
    }
    float perTrust = trust > 0.0 ? 1.0 / trust : 0.0;
    [[unroll]] for (uint c = 0u; c < 4u; ++c) known[c] *= perTrust;

    // The lobes there, as shading interpolates them.
    vec3 axis[kLobes];
    float axisLength[kLobes];
    float sharpness[kLobes];
    vec3 amplitude[kLobes];
    [[unroll]] for (uint k = 0u; k < kLobes; ++k) {
        vec3 axisSum = vec3(0.0);
        float logSharpness = 0.0;
        amplitude[k] = vec3(0.0);
        [[unroll]] for (uint c = 0u; c < 4u; ++c) {
            axisSum += weight[c] * parameter3(k, kSgFitAxis, texel[c]);
            logSharpness += weight[c] * parameter(k, kSgFitSharpness, texel[c]);
            amplitude[k] += weight[c] * parameter3(k, kSgFitAmplitude, texel[c]);
        }
        axisLength[k] = max(length(axisSum), kSgFitShortestAxis);
        axis[k] = axisSum / axisLength[k];
        sharpness[k] = exp(logSharpness);
    }

    // Loss and gradient over the directions of this step.
    vec3 towards[kLobes]; // sum of b d, where b = dL/d(lobe value) * lobe value / amplitude
    float dSharpness[kLobes];
    vec3 dAmplitude[kLobes];
    [[unroll]] for (uint k = 0u; k < kLobes; ++k) {
        towards[k] = vec3(0.0);
        dSharpness[k] = 0.0;
        dAmplitude[k] = vec3(0.0);
    }
    float loss = 0.0;
    float perMean = 1.0 / meanRadiance;
    float cellWeight = trust * perMean * perMean * float(push.directionCount / push.directionsPerStep);
    for (uint s = 0u; s < push.directionsPerStep; ++s) {
        uint direction = sgFitDirection(s, push.step, push.directionsPerStep, push.directionCount, push.seed);
        vec4 d = imageLoad(directions, int(direction));
        vec3 target = vec3(0.0);
        [[unroll]] for (uint c = 0u; c < 4u; ++c) {
            uint word = imageLoad(images, int(direction * push.imageTexels + texel[c] - push.firstTexel)).x;
            target += known[c] * unpackRgb9e5(word);
        }

        float exponent[kLobes];
        float value[kLobes];
        vec3 sum = vec3(0.0);
        [[unroll]] for (uint k = 0u; k < kLobes; ++k) {
            vec3 chord = d.xyz - axis[k];
            exponent[k] = -0.5 * sharpness[k] * dot(chord, chord);
            value[k] = exp(exponent[k]);
            sum += amplitude[k] * value[k];
        }

        float brightness = (target.x + target.y + target.z) * (1.0 / 3.0) * perMean;
        float sampleWeight = cellWeight * d.w / (1.0 + push.peakSoftening * brightness);
        vec3 residual = sum - target;
        vec3 dSum = residual * sampleWeight;
        loss += 0.5 * dot(dSum, residual);
        [[unroll]] for (uint k = 0u; k < kLobes; ++k) {
            float b = dot(dSum, amplitude[k]) * value[k];
            towards[k] += d.xyz * b;
            dSharpness[k] += b * exponent[k];
            dAmplitude[k] += dSum * value[k];
        }
    }

    // Through the normalisation of the axis: only the part across it counts.
    [[unroll]] for (uint k = 0u; k < kLobes; ++k) {
        vec3 across = towards[k] - axis[k] * dot(axis[k], towards[k]);
        vec3 dAxis = across * (sharpness[k] / axisLength[k]);
        uint base = k * kSgFitComponents * push.cellCount + cell;
        gradients[base] = dAxis.x;
        gradients[base + push.cellCount] = dAxis.y;
        gradients[base + 2u * push.cellCount] = dAxis.z;
        gradients[base + 3u * push.cellCount] = dSharpness[k];
        gradients[base + 4u * push.cellCount] = dAmplitude[k].x;
        gradients[base + 5u * push.cellCount] = dAmplitude[k].y;
        gradients[base + 6u * push.cellCount] = dAmplitude[k].z;
    }
    losses[cell] = loss;
}
