// A strand segment as a rectangle in the picture, grown by the pixel's reach on all sides: every pixel that the segment
// meets gets a fragment, and hairRectangleArea says how much of the pixel it covers. Segments that follow each other add up
// to the strand, also where it turns back within a pixel, as at the horizon of a head.
#ifndef STRANDLIGHT_HAIR_SEGMENT_GLSL
#define STRANDLIGHT_HAIR_SEGMENT_GLSL

#include "hair/points.glsl"
#include "shared/hair_coverage.h"

struct SegmentVertex
{
    vec4 clip;
    vec3 place;  // pixels: true width, signed distances from the segment's middle across and along
    vec3 extent; // unit direction in the picture, y down; length in pixels
    int first;   // of the segment's two points
};

SegmentVertex segmentVertex(uint vertex)
{
    const uint kCorners[6] = uint[6](0u, 1u, 2u, 2u, 1u, 3u);
    uint corner = kCorners[vertex % 6u];
    SegmentVertex result;
    result.first = int(imageLoad(segments, int(vertex / 6u)).x);
    vec4 ends[2] = vec4[2](clipOf(result.first), clipOf(result.first + 1));
    result.place = vec3(0.0);
    result.extent = vec3(1.0, 0.0, 0.0);
    if (min(ends[0].w, ends[1].w) < 1e-6) { // not before the camera
        result.clip = vec4(2.0, 2.0, 2.0, 1.0);
        return result;
    }
    vec2 along = 0.5 * push.size * (ends[1].xy / ends[1].w - ends[0].xy / ends[0].w);
    float size = length(along);
    vec2 direction = size > 1e-6 ? along / size : vec2(1.0, 0.0);
    int end = int(corner >> 1u);
    vec4 here = end == 0 ? ends[0] : ends[1];
    float outward = end == 0 ? -0.5 : 0.5, side = (corner & 1u) == 0u ? -0.5 : 0.5;
    // Ribbons are drawn with the tangents of their ends: as wide as those say, seen across the segment.
    float widths[2];
    for (int i = 0; i < 2; ++i) {
        int point = result.first + i;
        widths[i] = pixelWidth(point, ends[i].w) * abs(dot(direction, pictureTangent(point, ends[i])));
    }
    vec2 grown = vec2(side * (max(widths[0], widths[1]) + kHairPixelReach), outward * kHairPixelReach);
    vec2 pixels = vec2(-direction.y, direction.x) * grown.x + direction * grown.y + push.jitter;
    result.place = vec3(widths[end], grown.x, outward * size + grown.y);
    result.extent = vec3(direction, size);
    // The depth stays that of the end: beyond it there is no strand.
    result.clip = here + vec4(pixels * 2.0 / push.size * here.w, 0.0, 0.0);
    return result;
}

#endif
