// A strand segment as a ribbon in the picture: six vertices, two at each end of each triangle pair. Ribbons of one
// strand share their ends, so a straight strand covers every sample at most once.
// Wide and rectangular lines are optional in Vulkan; triangles cover the same samples on every device.
#ifndef STRANDLIGHT_HAIR_STRAND_GLSL
#define STRANDLIGHT_HAIR_STRAND_GLSL

#include "hair/points.glsl"

struct RibbonVertex
{
    vec4 clip;
    uvec2 ids;     // strand, first point of the segment: what the fragment's random bits depend on
    vec2 line;     // true width, signed distance from the strand's middle; pixels
    vec2 tangent;  // unit, in the picture, y down
    int point;
};

RibbonVertex ribbonVertex(uint vertex)
{
    const uint kCorners[6] = uint[6](0u, 1u, 2u, 2u, 1u, 3u);
    uint corner = kCorners[vertex % 6u];
    uvec2 segment = imageLoad(segments, int(vertex / 6u)).xy;
    RibbonVertex result;
    result.ids = segment.yx;
    result.point = int(segment.x + (corner >> 1u));
    vec4 clip = clipOf(result.point);
    result.tangent = pictureTangent(result.point, clip);
    float w = max(clip.w, 1e-6);
    float width = pixelWidth(result.point, w);
    float side = (corner & 1u) == 0u ? -1.0 : 1.0;
    float offset = side * 0.5 * max(width, push.minimumWidth);
    result.line = vec2(width, offset);
    vec2 pixels = vec2(-result.tangent.y, result.tangent.x) * offset + push.jitter;
    result.clip = clip + vec4(pixels * 2.0 / push.size * w, 0.0, 0.0);
    return result;
}

#endif
