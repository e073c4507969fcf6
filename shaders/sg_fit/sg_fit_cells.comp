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
layout(binding = 3, rgba32f) readonly uniform imageBuffer parameters; // [lobe * 2 + half, texel]
layout(binding = 4, r32f) readonly uniform imageBuffer scales;       // [texel] mean radiance, negative: no image
layout(binding = 5, scalar) writeonly buffer Gradients { vec4 gradients[]; }; // [lobe * 2 + half, cell]
layout(binding = 6, scalar) writeonly buffer Losses { float losses[]; };      // [cell]

layout(push_constant, scalar) uniform Push { SgFitCellPush push; };

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
    float steepness[kLobes]; // sharpness / ln 2
    float present[kLobes];   // sum of the weights of the texels that have the lobe
    vec3 amplitude[kLobes];
    [[unroll]] for (uint k = 0u; k < kLobes; ++k) {
        vec4 first = vec4(0.0); // axis, ln sharpness
        float missing = 0.0;
        amplitude[k] = vec3(0.0);
        [[unroll]] for (uint c = 0u; c < 4u; ++c) {
            int index = int(k * 2u * push.texelCount + texel[c]);
            vec4 second = imageLoad(parameters, index + int(push.texelCount)); // amplitude, dropped
            first += weight[c] * (1.0 - second.w) * imageLoad(parameters, index);
            amplitude[k] += weight[c] * (1.0 - second.w) * second.xyz;
            missing += weight[c] * second.w;
        }
        present[k] = max(1.0 - missing, kSgFitShortestAxis);
        axisLength[k] = max(length(first.xyz), kSgFitShortestAxis);
        axis[k] = first.xyz / axisLength[k];
        sharpness[k] = exp(first.w / present[k]);
        steepness[k] = sharpness[k] * 1.44269504;
    }

    // Loss and gradient over the directions of this step.
    vec3 towards[kLobes]; // sum of b d, where b = dL/d(ln value)
    float total[kLobes];  // sum of b
    vec3 dAmplitude[kLobes];
    [[unroll]] for (uint k = 0u; k < kLobes; ++k) {
        towards[k] = vec3(0.0);
        total[k] = 0.0;
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

        // Sharpness is at most the number of directions, so 1 - cos keeps enough digits here: the error of a value is
        // below sharpness x 2e-7.
        float value[kLobes];
        vec3 sum = vec3(0.0);
        [[unroll]] for (uint k = 0u; k < kLobes; ++k) {
            value[k] = exp2(steepness[k] * (dot(d.xyz, axis[k]) - 1.0));
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
            total[k] += b;
            dAmplitude[k] += dSum * value[k];
        }
    }

    // d value / d ln(lambda) = value lambda (d . axis - 1). Through the normalisation of the axis only the part across
    // it counts.
    [[unroll]] for (uint k = 0u; k < kLobes; ++k) {
        float along = dot(axis[k], towards[k]);
        vec3 dAxis = (towards[k] - axis[k] * along) * (sharpness[k] / axisLength[k]);
        float dSharpness = sharpness[k] * (along - total[k]) / present[k];
        uint index = k * 2u * push.cellCount + cell;
        gradients[index] = vec4(dAxis, dSharpness);
        gradients[index + push.cellCount] = vec4(dAmplitude[k], 0.0);
    }
    losses[cell] = loss;
}
