// Gradient of the mixture and its decoder: one invocation gathers over all directions of its lobe, in order.
// With SHUFFLE, eight lanes load eight directions and hand them round. dRaw is overwritten. Saved: raw (decoded again here, which is cheaper than loading the lobe).
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#include "nn/sg_lobe.glsl"

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint SHUFFLE = 0; // 1: the lobes are a multiple of eight, so a workgroup has one image
layout(binding = 0, r32f) uniform readonly imageBuffer raw;        // [N,L,7]
layout(binding = 1, r32f) uniform readonly imageBuffer directions; // [N,D,3] or [D,3], unit
layout(binding = 2, r32f) uniform readonly imageBuffer dRadiance;  // strides as in the forward pass
layout(binding = 3, scalar) writeonly buffer DRaw { float dRaw[]; };
layout(push_constant, scalar) uniform Push { SgMixturePush push; };

const uint kLanes = 8;

vec3 loadDirection(int list, uint d)
{
    int at = list + int(d) * 3;
    return vec3(imageLoad(directions, at).x, imageLoad(directions, at + 1).x, imageLoad(directions, at + 2).x);
}

vec3 loadOut(int image, uint d)
{
    int at = image + int(d * push.directionStride);
    int step = int(push.channelStride);
    return vec3(imageLoad(dRadiance, at).x, imageLoad(dRadiance, at + step).x, imageLoad(dRadiance, at + 2 * step).x);
}

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
    int along = int(n * push.directionImageStride);
    for (uint block = 0; block < push.directions; block += kLanes) {
        vec3 ownDirection = vec3(0.0);
        vec3 ownOut = vec3(0.0);
        if (SHUFFLE != 0) {
            uint own = min(block + gl_SubgroupInvocationID % kLanes, push.directions - 1);
            ownDirection = loadDirection(along, own);
            ownOut = loadOut(from, own);
        }
        [[unroll]] for (uint k = 0; k < kLanes; ++k) {
            // Past the last direction the last one is read again, with no gradient.
            bool there = block + k < push.directions;
            uint d = min(block + k, push.directions - 1);
            vec3 direction = SHUFFLE != 0 ? subgroupShuffle(ownDirection, k) : loadDirection(along, d);
            vec3 dOut = SHUFFLE != 0 ? subgroupShuffle(ownOut, k) : loadOut(from, d);
            dOut = there ? dOut : vec3(0.0);
            vec3 chord = direction - axis;
            float squared = dot(chord, chord);
            float weight = nnExp(-0.5 * sharpness * squared);
            float dExponent = dot(dOut, amplitude) * weight;
            dAmplitude += dOut * weight;
            dSharpness -= 0.5 * squared * dExponent;
            dAxis += dExponent * chord;
        }
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
