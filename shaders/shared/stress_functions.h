// The shared closed forms behind one signature, so that one kernel and one loop can put any of them under stress
// (passes/stress). Compiled three times: for the device, as C++, and as C++ in double (closed_forms_double.cpp).
#ifndef STRANDLIGHT_SHARED_STRESS_FUNCTIONS_H
#define STRANDLIGHT_SHARED_STRESS_FUNCTIONS_H

#ifdef __cplusplus
#include "shaders/shared/brdf.h"
#include "shaders/shared/hair_bsdf.h"
#include "shaders/shared/octahedral.h"
#include "shaders/shared/sg_specular.h"
#else
#include "shared/brdf.h"
#include "shared/hair_bsdf.h"
#include "shared/octahedral.h"
#include "shared/sg_specular.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// What the values of an item mean is said with each function.
struct StressInput
{
    vec4 a;
    vec4 b;
    vec4 c;
    vec4 d;
};

struct StressOutput
{
    vec4 x;
    vec4 y;
};

STRANDLIGHT_CONST(uint) kStressEvaluate = 0u;   // a: direction, sharpness; b: axis
STRANDLIGHT_CONST(uint) kStressIntegral = 1u;   // a.w: sharpness
STRANDLIGHT_CONST(uint) kStressProduct = 2u;    // a, b: axis, sharpness -> axis, sharpness; ln amplitude, inner product
STRANDLIGHT_CONST(uint) kStressHemisphere = 3u; // a.x: cosine, a.w: sharpness -> integral, fraction
STRANDLIGHT_CONST(uint) kStressIrradiance = 4u; // the same -> clamped-cosine integral
STRANDLIGHT_CONST(uint) kStressMeanLength = 5u; // a.w: sharpness, a.x: length -> length, sharpness
STRANDLIGHT_CONST(uint) kStressErf = 6u;        // a.x -> erf, erfc
STRANDLIGHT_CONST(uint) kStressNormalize = 7u;  // a.xyz
STRANDLIGHT_CONST(uint) kStressAsg = 8u;        // a: view, sharpness; b: axis, alpha; normal +z
STRANDLIGHT_CONST(uint) kStressNdf = 9u;        // the same
STRANDLIGHT_CONST(uint) kStressMixture = 10u;   // the same; c: lobe's axis.x and .z, sharpness, amplitude; d.xy: scale, bias
STRANDLIGHT_CONST(uint) kStressHair = 11u;      // a: tangent, roughness; b: light, tilt; c: view, shadow; d: color
STRANDLIGHT_CONST(uint) kStressBrdf = 12u;      // a: view, roughness; b: light, specular; c: color, metallic
STRANDLIGHT_CONST(uint) kStressOctahedral = 13u; // a.xyz -> decoded again: sphere, hemisphere
STRANDLIGHT_CONST(uint) kStressFunctions = 14u;

STRANDLIGHT_FN StressOutput stressSpecular(uint function, StressInput item)
{
    vec3 normal = vec3(0.0f, 0.0f, 1.0f);
    vec3 view = vec3(item.a.x, item.a.y, item.a.z);
    vec3 axis = vec3(item.b.x, item.b.y, item.b.z);
    StressOutput result;
    result.x = vec4(0.0f);
    result.y = vec4(0.0f);
    if (function == kStressAsg) {
        result.x.x = sgSpecularAsg(item.b.w, normal, view, axis, item.a.w);
    } else if (function == kStressNdf) {
        result.x.x = sgSpecularNdfFilter(item.b.w, normal, view, axis, item.a.w);
    } else {
        SgMixture mixture;
        for (int k = 0; k < 4; ++k) { // four like lobes of falling weight
            mixture.axis[k] = vec3(item.c.x, 0.0f, item.c.y);
            mixture.sharpness[k] = item.c.z / float(k + 1);
            mixture.amplitude[k] = item.c.w / float(k + 1);
        }
        mixture.scale = item.d.x;
        mixture.bias = item.d.y;
        vec2 value = sgSpecularMixture(mixture, normal, view, axis, item.a.w);
        result.x.x = value.x;
        result.x.y = value.y;
    }
    return result;
}

STRANDLIGHT_FN StressOutput stressScatter(uint function, StressInput item)
{
    vec3 a = vec3(item.a.x, item.a.y, item.a.z);
    vec3 b = vec3(item.b.x, item.b.y, item.b.z);
    vec3 c = vec3(item.c.x, item.c.y, item.c.z);
    StressOutput result;
    if (function == kStressHair) {
        vec3 color = vec3(item.d.x, item.d.y, item.d.z);
        vec3 once = hairScatter(a, b, c, color, item.a.w, item.b.w);
        vec3 often = hairMultipleScatter(a, b, c, color, item.c.w);
        result.x = vec4(once.x, once.y, once.z, 0.0f);
        result.y = vec4(often.x, often.y, often.z, 0.0f);
    } else {
        Surface surface = makeSurface(c, item.c.w, item.a.w, item.b.w, vec3(1.0f));
        BrdfValue value = evaluateBrdf(surface, a, b);
        result.x = vec4(value.value.x, value.value.y, value.value.z, value.pdf);
        result.y = vec4(0.0f);
    }
    return result;
}

STRANDLIGHT_FN StressOutput stressLobe(uint function, StressInput item)
{
    vec3 a = vec3(item.a.x, item.a.y, item.a.z);
    vec3 b = vec3(item.b.x, item.b.y, item.b.z);
    float lambda = item.a.w;
    StressOutput result;
    result.x = vec4(0.0f);
    result.y = vec4(0.0f);
    if (function == kStressEvaluate) {
        result.x.x = sgEvaluate(a, b, lambda);
    } else if (function == kStressIntegral) {
        result.x.x = sgIntegral(lambda);
    } else if (function == kStressProduct) {
        vec3 axis;
        float sharpness;
        float logAmplitude;
        sgProduct(a, lambda, b, item.b.w, axis, sharpness, logAmplitude);
        result.x = vec4(axis.x, axis.y, axis.z, sharpness);
        result.y.x = logAmplitude;
        result.y.y = sgInnerProduct(a, lambda, b, item.b.w);
    } else if (function == kStressHemisphere) {
        result.x.x = sgHemisphereIntegral(lambda, a.x);
        result.x.y = sgHemisphereFraction(lambda, a.x);
    } else if (function == kStressIrradiance) {
        result.x.x = sgIrradiance(lambda, a.x);
    } else if (function == kStressMeanLength) {
        result.x.x = sgMeanLength(lambda);
        result.x.y = sgSharpnessFromMeanLength(a.x);
    } else if (function == kStressErf) {
        result.x.x = errorFunction(a.x);
        result.x.y = errorFunctionComplement(a.x);
    } else if (function == kStressNormalize) {
        vec3 unit = safeNormalize(a, vec3(0.0f, 0.0f, 1.0f));
        result.x = vec4(unit.x, unit.y, unit.z, 0.0f);
    } else {
        vec3 whole = octDecode(octEncode(a));
        vec3 upper = hemiOctDecode(hemiOctEncode(vec3(a.x, a.y, abs(a.z))));
        result.x = vec4(whole.x, whole.y, whole.z, 0.0f);
        result.y = vec4(upper.x, upper.y, upper.z, 0.0f);
    }
    return result;
}

STRANDLIGHT_FN StressOutput stressFunction(uint function, StressInput item)
{
    if (function == kStressAsg || function == kStressNdf || function == kStressMixture) {
        return stressSpecular(function, item);
    }
    if (function == kStressHair || function == kStressBrdf) {
        return stressScatter(function, item);
    }
    return stressLobe(function, item);
}

STRANDLIGHT_SHARED_END

#endif
