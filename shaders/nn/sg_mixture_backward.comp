// Gradient of the mixture and its decoder: a lane is an image, an invocation gathers over all directions of LOBES of its
// lobes, in order. dRaw is overwritten. Saved: raw (decoded again here, which is cheaper than loading the lobe).
// VARIANT wide RESULT_WIDE
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#ifdef RESULT_WIDE
#include "nn/wide_store.glsl"
#endif

#include "nn/sg_lobe.glsl"

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint LOBES = 1; // of one invocation; wide: a multiple of eight
layout(constant_id = 1) const uint TILE = 1;  // directions at once, a multiple of four as in the forward pass, or 1
layout(binding = 0, r32f) uniform readonly imageBuffer lobes;      // [N,L,7] raw
layout(binding = 1, r32f) uniform readonly imageBuffer directions; // [N,D,3] or [D,3], unit
layout(binding = 2, rgba32f) uniform readonly imageBuffer directionQuads;
layout(binding = 3, r32f) uniform readonly imageBuffer dRadiance; // strides as in the forward pass
layout(binding = 4, rgba32f) uniform readonly imageBuffer dRadianceQuads;
#ifdef RESULT_WIDE
layout(binding = 5, scalar) writeonly buffer DRawOctets { u64vec4 dRawOctets[]; };
#else
layout(binding = 5, scalar) writeonly buffer DRaw { float dRaw[]; };
#endif
layout(binding = 6, rgba32f) uniform readonly imageBuffer lobeQuads;
layout(push_constant, scalar) uniform Push { SgMixturePush push; };

#include "nn/sg_directions.glsl"
#include "nn/sg_load_lobes.glsl"

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

float dValues[7 * LOBES + 7];

// `first`: lobe, a multiple of LOBES.
void storeLobeGradients(uint first)
{
    uint at = first * 7;
#ifdef RESULT_WIDE
    [[unroll]] for (uint i = 0; i < 7 * LOBES; i += 8)
        dRawOctets[(at + i) / 8] = asPairs(vec4(dValues[i], dValues[i + 1], dValues[i + 2], dValues[i + 3]),
                                           vec4(dValues[i + 4], dValues[i + 5], dValues[i + 6], dValues[i + 7]));
#else
    [[unroll]] for (uint i = 0; i < 7 * LOBES; ++i)
        dRaw[at + i] = dValues[i];
#endif
}

vec3 amplitude[LOBES];
vec3 dAxis[LOBES], dAmplitude[LOBES];
float dFalloff[LOBES]; // of -sharpness/2

// What lobe l gets from four directions from j on.
void addFour(uint l, uint j, Chords chords, vec4 lobe)
{
    [[unroll]] for (uint i = 0; i < OF_FOUR; ++i) {
        vec3 weighted = dOut[j + i] * lobe[i];
        float dExponent = dot(weighted, amplitude[l]);
        dAmplitude[l] += weighted;
        dFalloff[l] += chords.squared[i] * dExponent;
        dAxis[l] += dExponent * vec3(chords.x[i], chords.y[i], chords.z[i]);
    }
}

void main()
{
    uint n = push.firstImage + gl_GlobalInvocationID.x;
    if (n >= push.images)
        return;
    uint firstLobe = n * push.lobes + gl_GlobalInvocationID.y * LOBES;
    vec3 rawAxis[LOBES], axis[LOBES], rawAmplitude[LOBES];
    float axisLength[LOBES], rawSharpness[LOBES], sharpness[LOBES];
    float falloff[LOBES]; // -sharpness/2, for powers of two
    loadLobeValues(firstLobe);
    [[unroll]] for (uint l = 0; l < LOBES; ++l) {
        rawAxis[l] = vec3(lobeValues[7 * l], lobeValues[7 * l + 1], lobeValues[7 * l + 2]);
        rawSharpness[l] = lobeValues[7 * l + 3];
        rawAmplitude[l] = vec3(lobeValues[7 * l + 4], lobeValues[7 * l + 5], lobeValues[7 * l + 6]);
        axisLength[l] = rawAxisLength(rawAxis[l]);
        axis[l] = decodeAxis(rawAxis[l], axisLength[l]);
        sharpness[l] = decodeSharpness(rawSharpness[l]);
        amplitude[l] = vec3(nnSoftplus(rawAmplitude[l].x), nnSoftplus(rawAmplitude[l].y), nnSoftplus(rawAmplitude[l].z));
        dAxis[l] = dAmplitude[l] = vec3(0.0);
        falloff[l] = -0.5 * kLog2E * sharpness[l];
        dFalloff[l] = 0.0;
    }

    for (uint first = 0; first < push.directions; first += TILE) {
        loadDirections(n, first);
        loadOut(n, first);
        [[unroll]] for (uint l = 0; l < LOBES; ++l)
            [[unroll]] for (uint j = 0; j < TILE; j += 8) {
                Chords left = chordsTo(axis[l], j), right = chordsTo(axis[l], j + 4);
                vec4 lobe[2] = vec4[2](falloff[l] * left.squared, falloff[l] * right.squared);
                nnExp2Negative(lobe);
                addFour(l, j, left, lobe[0]);
                if (j + 4 < TILE)
                    addFour(l, j + 4, right, lobe[1]);
            }
    }

    // Back through the decoder: the part tangent to the sphere, over the raw length.
    [[unroll]] for (uint l = 0; l < LOBES; ++l) {
        dAxis[l] *= sharpness[l];
        vec3 tangent =
            axisLength[l] == 0.0 ? vec3(0.0) : (dAxis[l] - axis[l] * dot(axis[l], dAxis[l])) / axisLength[l];
        [[unroll]] for (uint c = 0; c < 3; ++c) {
            dValues[7 * l + c] = tangent[c];
            dValues[7 * l + 4 + c] = dAmplitude[l][c] * nnSigmoid(rawAmplitude[l][c]);
        }
        dValues[7 * l + 3] = -0.5 * dFalloff[l] * decodeSharpnessDerivative(rawSharpness[l], sharpness[l]);
    }
    storeLobeGradients(firstLobe);
}
