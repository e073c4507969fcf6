// The surface model: glTF 2.0 metallic-roughness with KHR_materials_specular.
// Lambert under a dielectric or metallic GGX layer; height-correlated Smith shadowing.
//   Walter, Marschner, Li, Torrance. Microfacet Models for Refraction through Rough Surfaces. 2007
//   Heitz. Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs. 2014
//   Heitz. Sampling the GGX Distribution of Visible Normals. 2018
//
// Directions are local: the shading normal is +z, both point away from the surface. As glTF defines it the diffuse
// part is weighted by 1 - F(v.h), which is reciprocal but lets a white surface pass 1 at grazing angles.
#ifndef STRANDLIGHT_SHARED_BRDF_H
#define STRANDLIGHT_SHARED_BRDF_H

#ifdef __cplusplus
#include "shaders/shared/sampling.h"
#else
#include "shared/sampling.h"
#endif

STRANDLIGHT_SHARED_BEGIN

struct Surface
{
    vec3 diffuse; // albedo of the Lambert part
    vec3 f0;      // reflectance of the layer at normal incidence
    float f90;    // at grazing incidence; 0 with f0 = 0: no layer, exactly Lambert
    float alpha;  // GGX roughness, >= kSmallestAlpha
};

STRANDLIGHT_CONST(float) kSmallestAlpha = 1e-3f;

// Factors as glTF gives them (roughness is perceptual, specular and specularColor from KHR_materials_specular).
STRANDLIGHT_FN Surface makeSurface(vec3 baseColor, float metallic, float roughness, float specular, vec3 specularColor)
{
    vec3 dielectric = min(vec3(0.04f) * specularColor, vec3(1.0f)) * specular;
    Surface surface;
    surface.diffuse = baseColor * (1.0f - metallic);
    surface.f0 = mix(dielectric, baseColor, metallic);
    surface.f90 = mix(specular, 1.0f, metallic);
    surface.alpha = max(roughness * roughness, kSmallestAlpha);
    return surface;
}

// Schlick. An Inexpensive BRDF Model for Physically-based Rendering. 1994
STRANDLIGHT_FN vec3 fresnel(Surface surface, float cosine)
{
    float m = max(1.0f - cosine, 0.0f);
    float m2 = m * m;
    float m5 = m2 * m2 * m;
    return surface.f0 + (vec3(surface.f90) - surface.f0) * m5;
}

// Density of microfacet normals, 1/sr. In components of h, so that small alpha keeps its digits.
STRANDLIGHT_FN float ggxDistribution(vec3 h, float alpha)
{
    float a2 = alpha * alpha;
    float t = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
    return kInversePi / (a2 * t * t);
}

// Smith's auxiliary function: G1 = 1 / (1 + lambda).
STRANDLIGHT_FN float ggxLambda(vec3 d, float alpha)
{
    float tan2 = (d.x * d.x + d.y * d.y) / (d.z * d.z);
    return 0.5f * (sqrt(1.0f + alpha * alpha * tan2) - 1.0f);
}

// Microfacet normal with density ggxNormalPdf, as seen from v.
STRANDLIGHT_FN vec3 sampleGgxNormal(vec3 v, float alpha, float u1, float u2)
{
    // Stretch to the hemisphere configuration.
    vec3 vh = normalize(vec3(alpha * v.x, alpha * v.y, v.z));
    float lengthSquared = vh.x * vh.x + vh.y * vh.y;
    vec3 t1 = lengthSquared > 1e-12f ? vec3(-vh.y, vh.x, 0.0f) * (1.0f / sqrt(lengthSquared)) : vec3(1.0f, 0.0f, 0.0f);
    vec3 t2 = cross(vh, t1);

    // A point of the projected area of the visible half disk.
    float r = sqrt(u1);
    float phi = 2.0f * kPi * u2;
    float p1 = r * cos(phi);
    float p2 = r * sin(phi);
    float s = 0.5f * (1.0f + vh.z);
    p2 = (1.0f - s) * sqrt(max(1.0f - p1 * p1, 0.0f)) + s * p2;
    vec3 nh = p1 * t1 + p2 * t2 + sqrt(max(1.0f - p1 * p1 - p2 * p2, 0.0f)) * vh;

    // Unstretch.
    return normalize(vec3(alpha * nh.x, alpha * nh.y, max(nh.z, 1e-7f)));
}

// How often the layer is sampled instead of the Lambert part, from v.
STRANDLIGHT_FN float layerProbability(Surface surface, vec3 v)
{
    float layer = luminance(fresnel(surface, v.z));
    float base = luminance(surface.diffuse);
    float total = layer + base;
    // Never nearly 0 where there is a layer: its highlights would be rare and bright.
    return layer <= 0.0f ? 0.0f : (base <= 0.0f ? 1.0f : clamp(layer / total, 0.1f, 0.9f));
}

struct BrdfValue
{
    vec3 value; // f * cos of the light direction, 1/sr
    float pdf;  // density of sampleBrdf for this light direction, 1/sr
};

// Both directions unit, v.z > 0; zero below the horizon.
STRANDLIGHT_FN BrdfValue evaluateBrdf(Surface surface, vec3 v, vec3 l)
{
    BrdfValue result;
    result.value = vec3(0.0f);
    result.pdf = 0.0f;
    bool above = l.z > 0.0f && v.z > 0.0f;
    vec3 h = v + l;
    h = h * (1.0f / sqrt(max(dot(h, h), 1e-20f)));
    float vh = clamp(dot(v, h), 0.0f, 1.0f);
    vec3 f = fresnel(surface, vh);
    float probability = layerProbability(surface, v);
    float cosine = max(l.z, 1e-7f);
    vec3 safeL = vec3(l.x, l.y, cosine);
    vec3 safeV = vec3(v.x, v.y, max(v.z, 1e-7f));
    float d = ggxDistribution(h, surface.alpha);
    float lambdaV = ggxLambda(safeV, surface.alpha);
    float lambdaL = ggxLambda(safeL, surface.alpha);
    // f cos = F D G2 / (4 v.z); the density of visible normals brings G1(v) D / (4 v.z).
    float common_ = d / (4.0f * safeV.z);
    vec3 layer = f * (common_ / (1.0f + lambdaV + lambdaL));
    float layerPdf = common_ / (1.0f + lambdaV);
    float diffuseWeight = 1.0f - max(max(f.x, f.y), f.z);
    vec3 base = surface.diffuse * (diffuseWeight * cosine * kInversePi);
    result.value = above ? base + layer : vec3(0.0f);
    result.pdf = above ? probability * layerPdf + (1.0f - probability) * cosine * kInversePi : 0.0f;
    return result;
}

// A light direction with the density of evaluateBrdf; may lie below the horizon (then nothing is reflected).
STRANDLIGHT_FN vec3 sampleBrdf(Surface surface, vec3 v, vec3 uniforms)
{
    bool layer = uniforms.z < layerProbability(surface, v);
    vec3 h = sampleGgxNormal(v, surface.alpha, uniforms.x, uniforms.y);
    vec3 mirrored = h * (2.0f * dot(v, h)) - v;
    vec3 cosine = sampleCosineHemisphere(uniforms.x, uniforms.y);
    return layer ? mirrored : cosine;
}

STRANDLIGHT_SHARED_END

#endif
