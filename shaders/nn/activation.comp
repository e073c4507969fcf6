// Elementwise functions that a convolution does not fuse, forward and backward (reference/activation.hpp).
// VARIANT to_half RESULT_HALF
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "nn/elements.glsl"
#include "shared/nn_types.h"
#include "nn/nn_math.glsl"

layout(local_size_x = 32) in;
layout(constant_id = 0) const uint KIND = 0;     // ActivationKind; 5: ln(1 + x), the encoder's view of radiance
layout(constant_id = 1) const uint BACKWARD = 0; // 0: result = f(input). 1: result += input f'(saved), saved = f(x)

layout(binding = 0, r32f) uniform readonly imageBuffer inputTensor;
layout(binding = 1, r32f) uniform readonly imageBuffer saved;
layout(binding = 2, scalar) buffer Result { RESULT_ELEMENT result[]; };
layout(push_constant, scalar) uniform Push { ElementPush push; };

float forward(float x)
{
    if (KIND == 1u)
        return nnPositive(x); // 0 * x would do, but compilers make it 0
    if (KIND == 2u)
        return x > 0.0 ? x : push.slope * x;
    if (KIND == 3u)
        return nnSoftplus(x);
    if (KIND == 4u)
        return nnSigmoid(x);
    if (KIND == 5u)
        return nnLog1p(nnPositive(x));
    return x;
}

float derivative(float y)
{
    if (KIND == 1u)
        return y > 0.0 ? 1.0 : 0.0;
    if (KIND == 2u)
        return y > 0.0 ? 1.0 : push.slope;
    if (KIND == 3u)
        return nnOneMinusExp(y);
    if (KIND == 4u)
        return y * (1.0 - y);
    return 1.0;
}

void main()
{
    uint r = gl_GlobalInvocationID.x + gl_GlobalInvocationID.z * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint n = gl_GlobalInvocationID.y;
    if (r >= push.channelPixels)
        return;
    float value = imageLoad(inputTensor, int(push.source.offset + n * push.source.imageStride + r)).x;
    uint at = push.result.offset + n * push.result.imageStride + r;
    if (BACKWARD == 0u)
        result[at] = RESULT_ELEMENT(forward(value));
    else
        result[at] = RESULT_ELEMENT(float(result[at]) + value * derivative(imageLoad(saved, int(push.saved.offset + n * push.saved.imageStride + r)).x));
}
