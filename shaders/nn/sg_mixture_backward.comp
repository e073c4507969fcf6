// Gradient of the mixture and its decoder: one invocation gathers over all directions of its lobe, in order.
// dRaw is overwritten. Saved: raw (decoded again here, which is cheaper than loading the lobe).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "nn/sg_lobe.glsl"

layout(local_size_x = 8) in;
layout(binding = 0, r32f) uniform readonly imageBuffer raw;        // [N,L,7]
layout(binding = 1, r32f) uniform readonly imageBuffer directions; // [N,D,3] or [D,3], unit
layout(binding = 2, r32f) uniform readonly imageBuffer dRadiance;  // strides as in the forward pass
layout(binding = 3, scalar) writeonly buffer DRaw { float dRaw[]; };
layout(push_constant, scalar) uniform Push { SgMixturePush push; };

void main()
{
    uint lobe = gl_GlobalInvocationID.x + push.firstImage * push.lobes;
    if (lobe >= push.images * push.lobes)
        return;
    uint n = lobe / push.lobes;
    int at = int(lobe) * 7;
    vec3 rawAxis = vec3(imageLoad(raw, at).x, imageLoad(raw, at + 1).x, imageLoad(raw, at + 2).x);
    float rawSharpness = imageLoad(raw, at + 3).x;
    vec3 rawAmplitude = vec3(imageLoad(raw, at + 4).x, imageLoad(raw, at + 5).x, imageLoad(raw, at + 6).x);
    float axisLength = rawAxisLength(rawAxis);
    vec3 axis = decodeAxis(rawAxis, axisLength);
    float sharpness = decodeSharpness(rawSharpness);
    vec3 amplitude = vec3(nnSoftplus(rawAmplitude.x), nnSoftplus(rawAmplitude.y), nnSoftplus(rawAmplitude.z));

    vec3 dAxis = vec3(0.0);
    vec3 dAmplitude = vec3(0.0);
    float dSharpness = 0.0;
    int from = int(n * 3 * push.directions);
    int directionAt = int(n * push.directionImageStride);
    for (uint d = 0; d < push.directions; ++d, from += int(push.directionStride), directionAt += 3) {
        vec3 direction = vec3(imageLoad(directions, directionAt).x, imageLoad(directions, directionAt + 1).x,
                              imageLoad(directions, directionAt + 2).x);
        vec3 dOut = vec3(imageLoad(dRadiance, from).x, imageLoad(dRadiance, from + int(push.channelStride)).x,
                         imageLoad(dRadiance, from + 2 * int(push.channelStride)).x);
        vec3 chord = direction - axis;
        float squared = dot(chord, chord);
        float weight = nnExp(-0.5 * sharpness * squared);
        float dExponent = dot(dOut, amplitude) * weight;
        dAmplitude += dOut * weight;
        dSharpness -= 0.5 * squared * dExponent;
        dAxis += dExponent * chord;
    }
    dAxis *= sharpness;

    // Back through the decoder: the part tangent to the sphere, over the raw length.
    vec3 tangent = axisLength == 0.0 ? vec3(0.0) : (dAxis - axis * dot(axis, dAxis)) / axisLength;
    dRaw[at] = tangent.x;
    dRaw[at + 1] = tangent.y;
    dRaw[at + 2] = tangent.z;
    dRaw[at + 3] = dSharpness * decodeSharpnessDerivative(rawSharpness, sharpness);
    dRaw[at + 4] = dAmplitude.x * nnSigmoid(rawAmplitude.x);
    dRaw[at + 5] = dAmplitude.y * nnSigmoid(rawAmplitude.y);
    dRaw[at + 6] = dAmplitude.z * nnSigmoid(rawAmplitude.z);
}
