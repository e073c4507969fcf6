// GGX reflection of a spherical gaussian light.
//
// Default: the BRDF slice of one view is a sum of four SGs times the clamped cosine, taken from a small table over
// (alpha, view angle) that passes/specular_lut.cpp fits by expectation maximisation. The product with the light is
// again an SG, and its clamped-cosine integral is sgIrradiance, so the horizon and wide lights are right by
// construction: mean error 0.03 where the seed's ASG has 0.4 (tests/unit/test_sg_specular.cpp prints the table).
// Named alternatives:
//   ASG   Xu, Sun, Dong, Zhao, Wu, Hu. Anisotropic Spherical Gaussians. 2013; Pettineo. SG Series, part 4. 2016
//   NDF   Tokuyoshi, Ikeda, Kulkarni, Harada. Hierarchical Light Sampling with Accurate SG Lighting. 2024
// Walter, Marschner, Li, Torrance. Microfacet Models for Refraction through Rough Surfaces. 2007 (GGX)
#ifndef STRANDLIGHT_SHARED_SG_SPECULAR_H
#define STRANDLIGHT_SHARED_SG_SPECULAR_H

#ifdef __cplusplus
#include "shaders/shared/sg_diffuse.h"
#else
#include "shared/sg_diffuse.h"
#endif

STRANDLIGHT_SHARED_BEGIN

STRANDLIGHT_CONST(uint) kSpecularTableAlphas = 16u;
STRANDLIGHT_CONST(uint) kSpecularTableViews = 32u;

// Below this alpha the reflection of the light field is no sharper: its lobes are wider than that anyway.
STRANDLIGHT_CONST(float) kSpecularTableMinAlpha = 0.02f;

// One view's GGX slice: D V (n.l) F(=1) ~ sum of amplitude SG(axis, sharpness) max(n.l, 0).
struct SgMixture {
    vec3 axis[4];       // unit, in the frame of the normal and view that were given
    float sharpness[4];
    float amplitude[4];
    float scale;        // directional albedo = f0 scale + f90 bias
    float bias;
};

// Where (alpha, cosView) lies in the table, [0,1]^2 between texel centres: x by ln alpha, y by view angle.
STRANDLIGHT_FN vec2 specularTableUv(float alpha, float cosView)
{
    float a = clamp(alpha, kSpecularTableMinAlpha, 1.0f);
    float x = 1.0f - log(a) / log(kSpecularTableMinAlpha);
    float y = acos(clamp(cosView, 0.0f, 1.0f)) * (2.0f / kPi);
    return vec2((x * float(kSpecularTableAlphas - 1u) + 0.5f) / float(kSpecularTableAlphas),
                (y * float(kSpecularTableViews - 1u) + 0.5f) / float(kSpecularTableViews));
}

// A table row (axis.x, axis.z) ln(1 + sharpness) in the plane of view and normal: it interpolates well, because
// sharp lobes blend in log sharpness and wide ones pass smoothly through zero.
STRANDLIGHT_FN void decodeSpecularLobe(vec4 row, STRANDLIGHT_OUT(vec2) axis, STRANDLIGHT_OUT(float) sharpness)
{
    float r = sqrt(row.x * row.x + row.y * row.y);
    axis = r > 1.0e-6f ? vec2(row.x, row.y) / r : vec2(0.0f, 1.0f);
    sharpness = min(exp(min(r, 12.0f)) - 1.0f, kSgMaxSharpness);
}

// Four interpolated table rows (lobe.xy, weight, -) with scale in row0.w and bias in row1.w.
STRANDLIGHT_FN SgMixture specularMixture(vec4 row0, vec4 row1, vec4 row2, vec4 row3, vec3 normal, vec3 view)
{
    SgMixture mixture;
    mixture.scale = row0.w;
    mixture.bias = row1.w;
    // The lobes' plane: x away from the viewer, z along the normal. At normal incidence any x will do (they are upright).
    vec3 away = safeNormalize(normal * dot(normal, view) - view, vec3(0.0f));
    for (int k = 0; k < 4; ++k) {
        vec4 row = k == 0 ? row0 : (k == 1 ? row1 : (k == 2 ? row2 : row3));
        vec2 axis;
        float sharpness;
        decodeSpecularLobe(row, axis, sharpness);
        mixture.axis[k] = safeNormalize(away * axis.x + normal * axis.y, normal);
        mixture.sharpness[k] = sharpness;
        mixture.amplitude[k] = (row0.w + row1.w) * row.z / max(sgIrradiance(sharpness, axis.y), 1.0e-20f);
    }
    return mixture;
}

// The same four lobes with the cosine folded in, each as the normalised SG of equal mean direction: what a prefiltered
// environment is looked up with. Narrow at grazing views, where one lobe about the mirror direction is far too wide.
struct SgMeanLobes {
    vec3 axis[4];
    float sharpness[4];
    float weight[4]; // sum 1
};

// Table rows 0..3 for the weights, rows 4 and 5 for the means (two lobes each).
STRANDLIGHT_FN SgMeanLobes specularMeanLobes(vec4 weights, vec4 row4, vec4 row5, float alpha, vec3 normal, vec3 view)
{
    vec3 away = safeNormalize(normal * dot(normal, view) - view, vec3(0.0f));
    // The table ends at its smallest alpha. From there the slice shrinks towards the mirror direction with alpha.
    float shrink = min(max(alpha, 1.0e-4f) / kSpecularTableMinAlpha, 1.0f);
    vec3 mirror = normal * (2.0f * dot(normal, view)) - view;
    SgMeanLobes lobes;
    for (int k = 0; k < 4; ++k) {
        vec4 pair = k < 2 ? row4 : row5;
        vec4 row = (k == 0 || k == 2) ? vec4(pair.x, pair.y, 0.0f, 0.0f) : vec4(pair.z, pair.w, 0.0f, 0.0f);
        vec2 axis;
        float sharpness;
        decodeSpecularLobe(row, axis, sharpness);
        vec3 lobeAxis = safeNormalize(away * axis.x + normal * axis.y, normal);
        lobes.axis[k] = safeNormalize(mix(mirror, lobeAxis, shrink), normal);
        lobes.sharpness[k] = sharpness / (shrink * shrink);
        lobes.weight[k] = weights[k];
    }
    return lobes;
}

// (1 - v.h)^5 for light from direction l. Schlick. An Inexpensive BRDF Model for Physically-based Rendering. 1994
STRANDLIGHT_FN float schlickWeight(vec3 view, vec3 l)
{
    // v.h = |v + l| / 2 for unit vectors
    vec3 sum = view + l;
    float x = clamp(1.0f - 0.5f * length(sum), 0.0f, 1.0f);
    float x2 = x * x;
    return x2 * x2 * x;
}

// Mean Schlick weight over the cosine-weighted hemisphere: what Fresnel takes from diffuse light that comes from all
// sides. A fit of our own to quadrature, 6e-6.
STRANDLIGHT_FN float diffuseSchlickWeight(float cosView)
{
    float c = clamp(cosView, 0.0f, 1.0f);
    return 0.02815949f + c * (-0.07983103f + c * (0.08637031f + c * (-0.04353026f + c * 0.008913155f)));
}

// Mean Schlick weight over a lobe: where it is sharp, the weight at its axis; where it is wide, the mean over the
// whole slice. A half-way sharpness of 8 is the best on the grid of the test (0.087; axis alone 0.113, mean 0.215).
STRANDLIGHT_FN float lobeSchlickWeight(float wideMean, vec3 view, vec3 normal, vec3 axis, float lambda)
{
    // An axis below the horizon stands for light just above it.
    float cosine = dot(axis, normal);
    vec3 above = cosine < 0.05f ? safeNormalize(axis + normal * (0.05f - cosine), normal) : axis;
    return mix(wideMean, schlickWeight(view, above), lambda / (lambda + 8.0f));
}

// Radiance reflected from a unit light lobe = f0 x + f90 y.
STRANDLIGHT_FN vec2 sgSpecularMixture(SgMixture mixture, vec3 normal, vec3 view, vec3 axis, float lambda)
{
    float wideMean = mixture.bias / max(mixture.scale + mixture.bias, 1.0e-20f);
    vec2 sum = vec2(0.0f);
    for (int k = 0; k < 4; ++k) {
        vec3 productAxis;
        float productSharpness;
        float logAmplitude;
        sgProduct(mixture.axis[k], mixture.sharpness[k], axis, lambda, productAxis, productSharpness, logAmplitude);
        float cosine = clamp(dot(productAxis, normal), -1.0f, 1.0f);
        float value = mixture.amplitude[k] * exp(logAmplitude) * sgIrradiance(productSharpness, cosine);
        float weight = lobeSchlickWeight(wideMean, view, normal, productAxis, productSharpness);
        sum += vec2(value - value * weight, value * weight);
    }
    return sum;
}

// --- alternatives, for F = 1: the thesis takes Fresnel at the mirror direction -----------------------------------------

STRANDLIGHT_FN float smithVisibilityTerm(float cosine, float alpha2)
{
    return 1.0f / (cosine + sqrt(alpha2 + (1.0f - alpha2) * cosine * cosine));
}

// The thesis's way: the distribution as an SG, warped to an ASG about the mirror direction, convolved with the light;
// visibility and cosine at the lobe's centre. Wide lobes and grazing views are 40-65 % off.
STRANDLIGHT_FN float sgSpecularAsg(float alpha, vec3 normal, vec3 view, vec3 axis, float lambda)
{
    float alpha2 = max(alpha * alpha, 1.0e-5f);
    float cosView = max(dot(normal, view), 1.0e-4f);
    vec3 mirror = safeNormalize(normal * (2.0f * dot(normal, view)) - view, normal);
    vec3 other = abs(normal.x) < 0.9f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f);
    vec3 x = safeNormalize(cross(normal, mirror), safeNormalize(cross(normal, other), other));
    vec3 y = safeNormalize(cross(mirror, x), other);

    // Xu's warp has 1 / (n.v)^2 along x; below 0.1 the lobe would be narrower than the mesh's normals justify.
    float warp = max(cosView, 0.1f);
    float sharpnessX = 2.0f / (8.0f * alpha2 * warp * warp);
    float sharpnessY = 2.0f / (8.0f * alpha2);

    // The SG light is the ASG of half its sharpness; 1 / (1/a + 1/b) instead of a b / (a + b) against overflow.
    float nu = max(0.5f * lambda, 1.0e-4f);
    float convolvedX = 1.0f / (1.0f / nu + 1.0f / sharpnessX);
    float convolvedY = 1.0f / (1.0f / nu + 1.0f / sharpnessY);
    float amplitude = kPi / sqrt((nu + sharpnessX) * (nu + sharpnessY));
    float px = dot(axis, x);
    float py = dot(axis, y);
    float lobe = amplitude * max(dot(mirror, axis), 0.0f) * exp(-convolvedX * px * px - convolvedY * py * py);

    float cosLight = max(dot(mirror, normal), 0.0f);
    float distribution = 1.0f / (kPi * alpha2);
    return lobe * distribution * smithVisibilityTerm(cosLight, alpha2) * smithVisibilityTerm(cosView, alpha2) * cosLight;
}

// Tokuyoshi 2024: the light's variance is added to the distribution in projected half-vector space, and the filtered
// distribution is evaluated at the lobe's half vector.
STRANDLIGHT_FN float sgSpecularNdfFilter(float alpha, vec3 normal, vec3 view, vec3 axis, float lambda)
{
    float alpha2 = clamp(alpha * alpha, 1.0e-6f, 0.9999f);
    // Frame with the view in the xz plane: then everything is diagonal.
    vec3 other = abs(normal.x) < 0.9f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f);
    vec3 x = safeNormalize(view - normal * dot(normal, view), safeNormalize(cross(normal, other), other));
    vec3 y = cross(normal, x);
    vec3 v = vec3(max(dot(view, x), 0.0f), 0.0f, max(dot(view, normal), 1.0e-3f));
    vec3 l = vec3(dot(axis, x), dot(axis, y), dot(axis, normal));

    float projected = alpha2 / (1.0f - alpha2);
    float variance = 2.0f / max(lambda, 1.0e-3f);
    float mx = projected + variance * 0.25f;
    float my = projected + variance * 0.25f / (v.z * v.z);
    float determinant = mx * my;
    float scale = 1.0f / (1.0f + mx + my + determinant);
    float filteredX = (mx + determinant) * scale; // squared roughness after filtering
    float filteredY = (my + determinant) * scale;

    vec3 h = safeNormalize(v + l, vec3(0.0f, 0.0f, 1.0f));
    float q = h.x * h.x / filteredX + h.y * h.y / filteredY + h.z * h.z;
    float distribution = 1.0f / (kPi * sqrt(filteredX * filteredY) * q * q);
    float lobe = distribution / (4.0f * sqrt(filteredX * v.x * v.x + v.z * v.z));

    // Share of light times reflection lobe that lies above the horizon; the lobe is about the dominant visible normal.
    float stretched = sqrt(alpha2 * v.x * v.x + v.z * v.z);
    vec3 visibleNormal = safeNormalize(vec3(alpha2 * v.x, 0.0f, stretched + v.z), vec3(0.0f, 0.0f, 1.0f));
    float reflectSharpness = (1.0f - alpha2) / (2.0f * alpha2);
    vec3 reflected = visibleNormal * (2.0f * dot(v, visibleNormal)) - v;
    vec3 sum = reflected * reflectSharpness + l * lambda;
    float sharpness = length(sum);
    float visible = sgHemisphereFraction(sharpness, clamp(sum.z / max(sharpness, 1.0e-20f), -1.0f, 1.0f));
    return visible * lobe * sgIntegral(lambda);
}

STRANDLIGHT_SHARED_END

#endif
