// Four neighbouring results of a correlation y[i] = sum over k of w[k] d[i + k] with 2 or 3 taps, from 5 products for 8 or
// 6 for 12: the polynomials d and w are evaluated at as many points, multiplied there, and y read off the product. Sums
// over channels and kernel rows are taken at the points, so that y is read off once.
// Winograd. Arithmetic Complexity of Computations. 1980
// Lavin, Gray. Fast Algorithms for Convolutional Neural Networks. 2016
//
// The points are a, -a, b, -b, infinity and, for 3 taps, 0. With the usual 1 and 2 the rounding is twice that of the plain
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

STRANDLIGHT_CONST(uint) kMinimalTile = 4u; // results of a tile

struct MinimalPoints
{
    float at[6]; // a, -a, b, -b, infinity, 0; with 2 taps the last is not used
};

STRANDLIGHT_FN uint minimalPoints(uint taps) { return taps + 3u; }
STRANDLIGHT_FN float minimalA(uint taps) { return taps == 3u ? 0.75f : 0.5f; }
STRANDLIGHT_CONST(float) kMinimalB = 1.5f;

// Of the weights w, the last of three unused with 2 taps.
STRANDLIGHT_FN float minimalWeight(uint taps, uint point, float w0, float w1, float w2)
{
    float a = minimalA(taps), b = kMinimalB;
    if (point == 4u)
        return taps == 3u ? w2 : w1;
    if (point == 5u)
        return w0 / (a * a * b * b);
    float p = (point < 2u ? a : b) * (point % 2u == 0u ? 1.0f : -1.0f);
    float other = point < 2u ? b : a;
    float scale = 2.0f * p * (p * p - other * other);
    return taps == 3u ? (w0 + p * (w1 + p * w2)) / (p * scale) : (w0 + p * w1) / scale;
}

// Of the inputs d[0 .. taps + 2].
STRANDLIGHT_FN MinimalPoints minimalInputs(uint taps, float d[6])
{
    float a = minimalA(taps), b = kMinimalB;
    uint s = taps - 2u; // the four that every point but 0 and infinity reads begin here
    float evenA = d[s + 3u] - b * b * d[s + 1u], oddA = a * (d[s + 2u] - b * b * d[s]);
    float evenB = d[s + 3u] - a * a * d[s + 1u], oddB = b * (d[s + 2u] - a * a * d[s]);
    MinimalPoints v;
    v.at[0] = evenA + oddA;
    v.at[1] = evenA - oddA;
    v.at[2] = evenB + oddB;
    v.at[3] = evenB - oddB;
    v.at[4] = d[s + 4u] - (a * a + b * b) * d[s + 2u] + a * a * b * b * d[s];
    v.at[5] = taps == 3u ? d[4] - (a * a + b * b) * d[2] + a * a * b * b * d[0] : 0.0f;
    return v;
}

// From the products, or their sums, at the points.
STRANDLIGHT_FN vec4 minimalResults(uint taps, MinimalPoints m)
{
    float a = minimalA(taps), b = kMinimalB;
    float evenA = m.at[0] + m.at[1], oddA = m.at[0] - m.at[1];
    float evenB = m.at[2] + m.at[3], oddB = m.at[2] - m.at[3];
    return vec4(evenA + evenB + (taps == 3u ? m.at[5] : 0.0f), a * oddA + b * oddB, a * a * evenA + b * b * evenB,
                a * a * a * oddA + b * b * b * oddB + m.at[4]);
}

// The other way about, for the gradient of three weights: y[k] = sum over i of s[i] d[i + k] over the four pixels of a
// tile. Its inputs d are taken to the points by minimalInputs(3, d), the pixels s by this, without the points' scales.
STRANDLIGHT_FN MinimalPoints minimalFilter(vec4 s)
{
    float a = minimalA(3u), b = kMinimalB;
    float evenA = s.x + a * a * s.z, oddA = a * (s.y + a * a * s.w);
    float evenB = s.x + b * b * s.z, oddB = b * (s.y + b * b * s.w);
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
    float a = minimalA(3u), b = kMinimalB;
    float scaleA = 1.0f / (2.0f * a * a * (a * a - b * b)), scaleB = 1.0f / (2.0f * b * b * (b * b - a * a));
    float evenA = scaleA * (m.at[0] + m.at[1]), oddA = scaleA * (m.at[0] - m.at[1]);
    float evenB = scaleB * (m.at[2] + m.at[3]), oddB = scaleB * (m.at[2] - m.at[3]);
    return vec3(evenA + evenB + m.at[5] / (a * a * b * b), a * oddA + b * oddB, a * a * evenA + b * b * evenB + m.at[4]);
}

STRANDLIGHT_SHARED_END

#endif
