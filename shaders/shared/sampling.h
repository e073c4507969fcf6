// Random variates and their densities. Each sampler takes uniforms in [0, 1) and has a pdf function beside it.
#ifndef STRANDLIGHT_SHARED_SAMPLING_H
#define STRANDLIGHT_SHARED_SAMPLING_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

STRANDLIGHT_CONST(float) kPi = 3.14159265358979324f;
STRANDLIGHT_CONST(float) kInversePi = 0.318309886183790672f;

// Densities below this drop the path: their reciprocal would be noise, not light.
STRANDLIGHT_CONST(float) kSmallestPdf = 1e-12f;

STRANDLIGHT_FN float luminance(vec3 c)
{
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

// Uniform point of the unit disk. Shirley and Chiu. A Low Distortion Map Between Disk and Square. 1997
STRANDLIGHT_FN vec2 sampleDisk(float u, float v)
{
    float a = 2.0f * u - 1.0f;
    float b = 2.0f * v - 1.0f;
    bool wide = abs(a) > abs(b);
    float r = wide ? a : b;
    float ratio = r == 0.0f ? 0.0f : (wide ? b / a : a / b);
    float phi = 0.785398163397448f * ratio;
    float c = cos(phi);
    float s = sin(phi);
    return wide ? vec2(r * c, r * s) : vec2(r * s, r * c);
}

// Unit direction around +z with density cos / pi.
STRANDLIGHT_FN vec3 sampleCosineHemisphere(float u, float v)
{
    vec2 p = sampleDisk(u, v);
    return vec3(p.x, p.y, sqrt(max(1.0f - p.x * p.x - p.y * p.y, 0.0f)));
}

STRANDLIGHT_FN float cosineHemispherePdf(float cosine)
{
    return max(cosine, 0.0f) * kInversePi;
}

// Barycentric weights of corners 1 and 2, uniform over a triangle.
STRANDLIGHT_FN vec2 sampleTriangle(float u, float v)
{
    float root = sqrt(u);
    return vec2(root * (1.0f - v), root * v);
}

// Weight of a sample from a density `own` when `other` could have made it too.
// Veach. Robust Monte Carlo Methods for Light Transport Simulation. 1997 (power heuristic, exponent 2)
STRANDLIGHT_FN float powerHeuristic(float own, float other)
{
    // As a ratio: squares of large densities would overflow.
    float r = other / own;
    return 1.0f / (1.0f + r * r);
}

// Point n of a two-dimensional low-discrepancy sequence on the unit square, moved by `shift` around its torus.
// Exact in integers, so the point does not depend on how far n is.
// Roberts. The Unreasonable Effectiveness of Quasirandom Sequences. 2018 (R2)
STRANDLIGHT_FN vec2 sequencePoint(uint n, vec2 shift)
{
    uint x = n * 3242174889u + uint(shift.x * 16777216.0f) * 256u;
    uint y = n * 2447445414u + uint(shift.y * 16777216.0f) * 256u;
    return vec2(float(x >> 8u) * (1.0f / 16777216.0f), float(y >> 8u) * (1.0f / 16777216.0f));
}

// One draw from an alias table: `u` picks the column and, by what is left of it, the entry.
// Vose. A Linear Algorithm for Generating Random Numbers with a Given Distribution. 1991
struct AliasDraw
{
    uint column;
    float rest; // uniform in [0, 1): the entry is `column` if rest < its threshold, else its alias
};

STRANDLIGHT_FN AliasDraw drawAlias(float u, uint count)
{
    float scaled = u * float(count);
    uint column = min(uint(scaled), count - 1u);
    AliasDraw draw;
    draw.column = column;
    draw.rest = scaled - float(column);
    return draw;
}

STRANDLIGHT_SHARED_END

#endif
