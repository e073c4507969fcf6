// Directions on a square: the hemisphere z >= 0 and the whole sphere.
// Cigolle, Donow, Evangelakos, Mara, McGuire, Meyer. A Survey of Efficient Representations for Independent Unit
// Vectors. 2014. Solid angles: Van Oosterom and Strackee. The Solid Angle of a Plane Triangle. 1983
#ifndef STRANDLIGHT_SHARED_OCTAHEDRAL_H
#define STRANDLIGHT_SHARED_OCTAHEDRAL_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Unit direction with z >= 0 to [0,1]^2. The pole (0,0,1) is the centre, the horizon is the border.
STRANDLIGHT_FN vec2 hemiOctEncode(vec3 d)
{
    float scale = 1.0f / (abs(d.x) + abs(d.y) + abs(d.z));
    float x = d.x * scale;
    float y = d.y * scale;
    return vec2(0.5f + 0.5f * (x + y), 0.5f + 0.5f * (x - y));
}

// The point of the octahedron |x| + |y| + z = 1 below which the direction lies; linear within each of four triangles.
STRANDLIGHT_FN vec3 hemiOctPoint(vec2 uv)
{
    float s = 2.0f * uv.x - 1.0f;
    float t = 2.0f * uv.y - 1.0f;
    float x = 0.5f * (s + t);
    float y = 0.5f * (s - t);
    return vec3(x, y, 1.0f - abs(x) - abs(y));
}

// [0,1]^2 to a unit direction with z >= 0.
STRANDLIGHT_FN vec3 hemiOctDecode(vec2 uv)
{
    return normalize(hemiOctPoint(uv));
}

// Solid angle of the spherical triangle of three unit vectors. The edge form keeps small triangles exact.
STRANDLIGHT_FN float sphericalTriangleSolidAngle(vec3 a, vec3 b, vec3 c)
{
    float numerator = abs(dot(a, cross(b - a, c - a)));
    float t = numerator / (1.0f + dot(a, b) + dot(b, c) + dot(c, a));
    if (t < 0.1f) {
        // The driver's atan may be poor near zero; four terms are exact in fp32 here.
        float t2 = t * t;
        return 2.0f * t * (1.0f - t2 * (1.0f / 3.0f - t2 * (0.2f - t2 * (1.0f / 7.0f))));
    }
    return 2.0f * atan(t);
}

// Steradians of cell (x, y) of a size x size hemi-octahedral image; all cells together are 2 pi.
// The folds of the map run along cell diagonals, so four triangles around the cell's centre are each exact.
STRANDLIGHT_FN float hemiOctSolidAngle(uint x, uint y, uint size)
{
    float step = 1.0f / float(size);
    float u0 = float(x) * step;
    float v0 = float(y) * step;
    float u1 = float(x + 1u) * step;
    float v1 = float(y + 1u) * step;
    vec3 centre = hemiOctDecode(vec2(0.5f * (u0 + u1), 0.5f * (v0 + v1)));
    vec3 a = hemiOctDecode(vec2(u0, v0));
    vec3 b = hemiOctDecode(vec2(u1, v0));
    vec3 c = hemiOctDecode(vec2(u1, v1));
    vec3 d = hemiOctDecode(vec2(u0, v1));
    return sphericalTriangleSolidAngle(centre, a, b) + sphericalTriangleSolidAngle(centre, b, c) +
           sphericalTriangleSolidAngle(centre, c, d) + sphericalTriangleSolidAngle(centre, d, a);
}

// Unit direction to [0,1]^2, whole sphere. The lower hemisphere is folded over the four edges.
STRANDLIGHT_FN vec2 octEncode(vec3 d)
{
    float scale = 1.0f / (abs(d.x) + abs(d.y) + abs(d.z));
    float x = d.x * scale;
    float y = d.y * scale;
    if (d.z < 0.0f) {
        float foldedX = (1.0f - abs(y)) * (x >= 0.0f ? 1.0f : -1.0f);
        y = (1.0f - abs(x)) * (y >= 0.0f ? 1.0f : -1.0f);
        x = foldedX;
    }
    return vec2(0.5f + 0.5f * x, 0.5f + 0.5f * y);
}

STRANDLIGHT_FN vec3 octDecode(vec2 uv)
{
    float x = 2.0f * uv.x - 1.0f;
    float y = 2.0f * uv.y - 1.0f;
    float z = 1.0f - abs(x) - abs(y);
    if (z < 0.0f) {
        float foldedX = (1.0f - abs(y)) * (x >= 0.0f ? 1.0f : -1.0f);
        y = (1.0f - abs(x)) * (y >= 0.0f ? 1.0f : -1.0f);
        x = foldedX;
    }
    return normalize(vec3(x, y, z));
}

STRANDLIGHT_SHARED_END

#endif
