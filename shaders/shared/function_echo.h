// One input per item for every shared shading function, drawn by the shared generator: the kernel and the C++ test
// call this same function and must agree.
#ifndef STRANDLIGHT_SHARED_FUNCTION_ECHO_H
#define STRANDLIGHT_SHARED_FUNCTION_ECHO_H

#ifdef __cplusplus
#include "shaders/shared/octahedral.h"
#include "shaders/shared/rng.h"
#include "shaders/shared/sg_specular.h"
#else
#include "shared/octahedral.h"
#include "shared/rng.h"
#include "shared/sg_specular.h"
#endif

STRANDLIGHT_SHARED_BEGIN

STRANDLIGHT_CONST(uint) kEchoValues = 24u;

// Uniform on the sphere.
STRANDLIGHT_FN vec3 echoDirection(uint item, uint dimension)
{
    vec3 u = uniform3(item, 0u, dimension, 1234u);
    float z = 2.0f * u.x - 1.0f;
    float r = sqrt(max(1.0f - z * z, 0.0f));
    return vec3(r * cos(2.0f * kPi * u.y), r * sin(2.0f * kPi * u.y), z);
}

struct FunctionEcho {
    float values[24];
};

STRANDLIGHT_FN FunctionEcho echoFunctions(uint item)
{
    vec3 u = uniform3(item, 0u, 0u, 99u);
    float lambda1 = exp(-6.9f + 16.0f * u.x); // 1e-3 .. 9e3
    float lambda2 = exp(-6.9f + 16.0f * u.y);
    vec3 a = echoDirection(item, 1u);
    vec3 b = safeNormalize(a + echoDirection(item, 2u) * u.z, vec3(0.0f, 0.0f, 1.0f));
    vec3 up = vec3(b.x, b.y, abs(b.z));
    vec3 normal = vec3(0.0f, 0.0f, 1.0f);
    vec3 seen = echoDirection(item, 3u);
    vec3 view = safeNormalize(vec3(seen.x, seen.y, abs(seen.z) + 0.02f), normal);
    float alpha = 0.03f + 0.9f * u.z;

    FunctionEcho e;
    vec3 axis;
    float lambda;
    float logAmplitude;
    sgProduct(a, lambda1, b, lambda2, axis, lambda, logAmplitude);
    e.values[0] = axis.x;
    e.values[1] = axis.y;
    e.values[2] = axis.z;
    e.values[3] = lambda / (lambda1 + lambda2);
    e.values[4] = exp(logAmplitude);
    e.values[5] = sgEvaluate(a, b, lambda1);
    e.values[6] = sgIntegral(lambda1);
    e.values[7] = sgInnerProduct(a, lambda1, b, lambda2);
    e.values[8] = sgIrradiance(lambda1, clamp(a.z, -1.0f, 1.0f));
    e.values[9] = sgIrradianceHill(1.0f + lambda1, clamp(a.z, -1.0f, 1.0f));
    e.values[10] = sgIrradianceWang(lambda1, clamp(a.z, -1.0f, 1.0f));
    e.values[11] = sgHemisphereIntegral(lambda1, clamp(a.z, -1.0f, 1.0f));
    e.values[12] = sgHemisphereFraction(lambda1, clamp(a.z, -1.0f, 1.0f));
    e.values[13] = sgMeanLength(lambda1);
    e.values[14] = log(1.0f + sgSharpnessFromMeanLength(0.999f * u.x));
    e.values[15] = errorFunction(6.0f * u.y - 3.0f);
    e.values[16] = errorFunctionComplement(6.0f * u.z - 3.0f);
    e.values[17] = sgSpecularAsg(alpha, normal, view, a, lambda1);
    e.values[18] = sgSpecularNdfFilter(alpha, normal, view, a, lambda1);
    e.values[19] = diffuseSchlickWeight(view.z) + schlickWeight(view, up);
    vec2 uv = hemiOctEncode(up);
    vec2 whole = octEncode(a);
    e.values[20] = uv.x + 2.0f * uv.y;
    e.values[21] = whole.x + 2.0f * whole.y;
    e.values[22] = dot(hemiOctDecode(vec2(u.x, u.y)), vec3(1.0f, 2.0f, 3.0f)) + octDecode(vec2(u.y, u.z)).z;
    e.values[23] = hemiOctSolidAngle(item % 16u, (item / 16u) % 16u, 16u);
    return e;
}

STRANDLIGHT_SHARED_END

#endif
