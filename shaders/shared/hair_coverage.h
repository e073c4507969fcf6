// How much of a pixel a thin strand covers: the area of a strip within a unit square, exact for a straight strand that
// crosses the pixel.
// Catmull. A Hidden-Surface Algorithm with Anti-Aliasing. 1978 (area coverage by a box of one pixel)
#ifndef STRANDLIGHT_SHARED_HAIR_COVERAGE_H
#define STRANDLIGHT_SHARED_HAIR_COVERAGE_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Strands further than half of this and half their width from a pixel's middle do not meet it: the square's diagonal.
STRANDLIGHT_CONST(float) kHairPixelReach = 1.41421357f;

// Area of the unit square around 0 beyond the line at `distance` >= 0 from 0, perpendicular to `across`; a unit vector
// with x >= y >= 0. Seen along the line, the square is a trapezoid: flat within `inner`, nothing beyond `outer`.
STRANDLIGHT_FN float hairAreaBeyond(float distance, vec2 across)
{
    float outer = 0.5f * (across.x + across.y);
    float inner = 0.5f * (across.x - across.y);
    float left = max(outer - distance, 0.0f);
    if (distance < inner) {
        return (0.5f * across.y + inner - distance) / across.x;
    }
    return across.y > 1e-6f ? 0.5f * left * left / (across.x * across.y) : 0.0f;
}

// Area of the unit square around 0 in the strip of `width` whose middle is at the signed `distance`; `across` is its unit
// normal. All in pixels. In [0, 1].
STRANDLIGHT_FN float hairStripArea(float width, float distance, vec2 across)
{
    vec2 n = abs(across);
    n = n.x >= n.y ? n : vec2(n.y, n.x);
    float far = abs(distance) + 0.5f * width, near = abs(distance) - 0.5f * width;
    float before = near >= 0.0f ? hairAreaBeyond(near, n) : 1.0f - hairAreaBeyond(-near, n);
    return clamp(before - hairAreaBeyond(far, n), 0.0f, 1.0f);
}

// Of the unit square around 0, the part in a rectangle of `width` across and `size` along the unit vector `direction`, whose
// middle is at the signed distances `across` and `along`: the product of both strips, exact where the rectangle is level or
// one strip holds the whole square. Rectangles end to end add up to a longer one.
STRANDLIGHT_FN float hairRectangleArea(float width, float across, float size, float along, vec2 direction)
{
    return hairStripArea(width, across, vec2(-direction.y, direction.x)) * hairStripArea(size, along, direction);
}

// The same in each quarter of the unit square, as a share of the quarter: -x -y, +x -y, -x +y, +x +y (y down). Their mean is
// the area in the square.
STRANDLIGHT_FN vec4 hairQuarterAreas(float width, float across, float size, float along, vec2 direction)
{
    vec4 areas;
    for (int i = 0; i < 4; ++i) {
        vec2 middle = vec2((i & 1) == 0 ? -0.25f : 0.25f, i < 2 ? -0.25f : 0.25f);
        float a = across - dot(middle, vec2(-direction.y, direction.x)), b = along - dot(middle, direction);
        areas[i] = hairRectangleArea(2.0f * width, 2.0f * a, 2.0f * size, 2.0f * b, direction);
    }
    return areas;
}

STRANDLIGHT_SHARED_END

#endif
