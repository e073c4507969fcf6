// Four neighbouring results of a correlation y[i] = sum over k of w[k] d[i + k] with three taps, from 6 products for 12: the
// polynomials d and w are evaluated at as many points, multiplied there, and y read off the product. Sums over channels and
// kernel rows are taken at the points, so that y is read off once.
// Winograd. Arithmetic Complexity of Computations. 1980
// Lavin, Gray. Fast Algorithms for Convolutional Neural Networks. 2016
//
// The points are a, -a, b, -b, infinity and 0. With the usual 1 and 2 for a and b the rounding is twice that of the plain
// sum; with these 1.4 times (Barabasz et al. Error Analysis and Improving the Accuracy of Winograd Convolution for Deep
// Neural Networks. 2020): they lie evenly about 1, and their powers up to the fourth are exact.
#ifndef STRANDLIGHT_SHARED_MINIMAL_FILTER_H
#define STRANDLIGHT_SHARED_MINIMAL_FILTER_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

STRANDLIGHT_CONST(uint) kMinimalTile = 4u;   // results of a tile
STRANDLIGHT_CONST(uint) kMinimalPoints = 6u; // products of it
STRANDLIGHT_CONST(float) kMinimalA = 0.75f;
STRANDLIGHT_CONST(float) kMinimalB = 1.5f;
STRANDLIGHT_CONST(float) kMinimalA2 = kMinimalA * kMinimalA;
STRANDLIGHT_CONST(float) kMinimalB2 = kMinimalB * kMinimalB;

struct MinimalPoints
{
    float at[6]; // a, -a, b, -b, infinity, 0
};

// Of the weights w at one point.
STRANDLIGHT_FN float minimalWeight(uint point, float w0, float w1, float w2)
{
    if (point == 4u)
        return w2;
    if (point == 5u)
        return w0 / (kMinimalA2 * kMinimalB2);
    float p = (point < 2u ? kMinimalA : kMinimalB) * (point % 2u == 0u ? 1.0f : -1.0f);
    float other2 = point < 2u ? kMinimalB2 : kMinimalA2;
    return (w0 + p * (w1 + p * w2)) / (2.0f * p * p * (p * p - other2));
}

STRANDLIGHT_FN MinimalPoints minimalInputs(float d[6])
{
    float evenA = d[4] - kMinimalB2 * d[2], oddA = kMinimalA * (d[3] - kMinimalB2 * d[1]);
    float evenB = d[4] - kMinimalA2 * d[2], oddB = kMinimalB * (d[3] - kMinimalA2 * d[1]);
    MinimalPoints v;
    v.at[0] = evenA + oddA;
    v.at[1] = evenA - oddA;
    v.at[2] = evenB + oddB;
    v.at[3] = evenB - oddB;
    v.at[4] = d[5] - (kMinimalA2 + kMinimalB2) * d[3] + kMinimalA2 * kMinimalB2 * d[1];
    v.at[5] = d[4] - (kMinimalA2 + kMinimalB2) * d[2] + kMinimalA2 * kMinimalB2 * d[0];
    return v;
}

// From the products, or their sums, at the points.
STRANDLIGHT_FN vec4 minimalResults(MinimalPoints m)
{
    float evenA = m.at[0] + m.at[1], oddA = m.at[0] - m.at[1];
    float evenB = m.at[2] + m.at[3], oddB = m.at[2] - m.at[3];
    return vec4(evenA + evenB + m.at[5], kMinimalA * oddA + kMinimalB * oddB, kMinimalA2 * evenA + kMinimalB2 * evenB,
                kMinimalA * kMinimalA2 * oddA + kMinimalB * kMinimalB2 * oddB + m.at[4]);
}

// The other way about, for the gradient of three weights: y[k] = sum over i of s[i] d[i + k] over the four pixels of a
// tile. Its inputs d are taken to the points by minimalInputs(), the pixels s by this, without the points' scales.
STRANDLIGHT_FN MinimalPoints minimalFilter(vec4 s)
{
    float evenA = s.x + kMinimalA2 * s.z, oddA = kMinimalA * (s.y + kMinimalA2 * s.w);
    float evenB = s.x + kMinimalB2 * s.z, oddB = kMinimalB * (s.y + kMinimalB2 * s.w);
    MinimalPoints u;
    u.at[0] = evenA + oddA;
    u.at[1] = evenA - oddA;
    u.at[2] = evenB + oddB;
    u.at[3] = evenB - oddB;
    u.at[4] = s.w;
    u.at[5] = s.x;
    return u;
}

// From the products of both, or their sums; the points' scales are applied here.
STRANDLIGHT_FN vec3 minimalTaps(MinimalPoints m)
{
    float scaleA = 1.0f / (2.0f * kMinimalA2 * (kMinimalA2 - kMinimalB2));
    float scaleB = 1.0f / (2.0f * kMinimalB2 * (kMinimalB2 - kMinimalA2));
    float evenA = scaleA * (m.at[0] + m.at[1]), oddA = scaleA * (m.at[0] - m.at[1]);
    float evenB = scaleB * (m.at[2] + m.at[3]), oddB = scaleB * (m.at[2] - m.at[3]);
    return vec3(evenA + evenB + m.at[5] / (kMinimalA2 * kMinimalB2), kMinimalA * oddA + kMinimalB * oddB,
                kMinimalA2 * evenA + kMinimalB2 * evenB + m.at[4]);
}

STRANDLIGHT_SHARED_END

#endif
