// Gradient of the mixture and its decoder: a lane is an image, an invocation gathers over all directions of LOBES of its
// lobes, in order. dRaw is overwritten. Saved: raw (decoded again here, which is cheaper than loading the lobe).
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "nn/sg_lobe.glsl"

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint LOBES = 1; // of one invocation
layout(constant_id = 1) const uint TILE = 1;  // directions at once, a multiple of four as in the forward pass, or 1
layout(binding = 0, r32f) uniform readonly imageBuffer raw;        // [N,L,7]
layout(binding = 1, r32f) uniform readonly imageBuffer directions; // [N,D,3] or [D,3], unit
layout(binding = 2, rgba32f) uniform readonly imageBuffer directionQuads;
layout(binding = 3, r32f) uniform readonly imageBuffer dRadiance; // strides as in the forward pass
layout(binding = 4, rgba32f) uniform readonly imageBuffer dRadianceQuads;
layout(binding = 5, scalar) writeonly buffer DRaw { float dRaw[]; };
layout(push_constant, scalar) uniform Push { SgMixturePush push; };

#include "nn/sg_directions.glsl"

vec3 dOut[TILE];

void loadOut(uint n, uint first)
{
    int at = int(n * 3 * push.directions + first * push.directionStride);
    [[unroll]] for (int c = 0; c < 3; ++c) {
        int from = at + c * int(push.channelStride);
        if (TILE % 4 == 0) {
            [[unroll]] for (uint j = 0; j < TILE; j += 4) {
                vec4 quad = imageLoad(dRadianceQuads, (from + int(j)) / 4);
                [[unroll]] for (uint i = 0; i < 4; ++i)
                    dOut[(j + i) % TILE][c] = quad[i];
            }
        } else {
            dOut[0][c] = imageLoad(dRadiance, from).x;
        }
    }
}

void main()
{
    uint n = push.firstImage + gl_GlobalInvocationID.x;
    if (n >= push.images)
        return;
    uint firstLobe = n * push.lobes + gl_GlobalInvocationID.y * LOBES;
    vec3 rawAxis[LOBES], axis[LOBES], rawAmplitude[LOBES], amplitude[LOBES];
    float axisLength[LOBES], rawSharpness[LOBES], sharpness[LOBES];
    vec3 dAxis[LOBES], dAmplitude[LOBES];
    float dSharpness[LOBES];
    [[unroll]] for (uint l = 0; l < LOBES; ++l) {
        int at = int(firstLobe + l) * 7;
        rawAxis[l] = vec3(imageLoad(raw, at).x, imageLoad(raw, at + 1).x, imageLoad(raw, at + 2).x);
        rawSharpness[l] = imageLoad(raw, at + 3).x;
        rawAmplitude[l] = vec3(imageLoad(raw, at + 4).x, imageLoad(raw, at + 5).x, imageLoad(raw, at + 6).x);
        axisLength[l] = rawAxisLength(rawAxis[l]);
        axis[l] = decodeAxis(rawAxis[l], axisLength[l]);
        sharpness[l] = decodeSharpness(rawSharpness[l]);
        amplitude[l] = vec3(nnSoftplus(rawAmplitude[l].x), nnSoftplus(rawAmplitude[l].y), nnSoftplus(rawAmplitude[l].z));
        dAxis[l] = dAmplitude[l] = vec3(0.0);
        dSharpness[l] = 0.0;
    }

    for (uint first = 0; first < push.directions; first += TILE) {
        loadDirections(n, first);
        loadOut(n, first);
        [[unroll]] for (uint l = 0; l < LOBES; ++l)
            [[unroll]] for (uint j = 0; j < TILE; ++j) {
                vec3 chord = direction[j] - axis[l];
                float squared = dot(chord, chord);
                vec3 weighted = dOut[j] * nnExp2Negative(-0.5 * kLog2E * sharpness[l] * squared);
                float dExponent = dot(weighted, amplitude[l]);
                dAmplitude[l] += weighted;
                dSharpness[l] -= 0.5 * squared * dExponent;
                dAxis[l] += dExponent * chord;
            }
    }

    // Back through the decoder: the part tangent to the sphere, over the raw length.
    [[unroll]] for (uint l = 0; l < LOBES; ++l) {
        uint at = (firstLobe + l) * 7;
        dAxis[l] *= sharpness[l];
        vec3 tangent =
            axisLength[l] == 0.0 ? vec3(0.0) : (dAxis[l] - axis[l] * dot(axis[l], dAxis[l])) / axisLength[l];
        dRaw[at] = tangent.x;
        dRaw[at + 1] = tangent.y;
        dRaw[at + 2] = tangent.z;
        dRaw[at + 3] = dSharpness[l] * decodeSharpnessDerivative(rawSharpness[l], sharpness[l]);
        dRaw[at + 4] = dAmplitude[l].x * nnSigmoid(rawAmplitude[l].x);
        dRaw[at + 5] = dAmplitude[l].y * nnSigmoid(rawAmplitude[l].y);
        dRaw[at + 6] = dAmplitude[l].z * nnSigmoid(rawAmplitude[l].z);
    }
}
