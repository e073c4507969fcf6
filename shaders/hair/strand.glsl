// A strand segment as a ribbon in the picture: six vertices, two at each end of each triangle pair. Ribbons of one
// strand share their ends, so a straight strand covers every sample at most once.
// Wide and rectangular lines are optional in Vulkan; triangles cover the same samples on every device.
#ifndef STRANDLIGHT_HAIR_STRAND_GLSL
#define STRANDLIGHT_HAIR_STRAND_GLSL

#include "shared/hair_types.h"

layout(binding = 0, rgba32f) uniform readonly imageBuffer points;
layout(binding = 1, rgba32f) uniform readonly imageBuffer tangents;
layout(binding = 2, rg32ui) uniform readonly uimageBuffer segments;
layout(push_constant, scalar) uniform Push { HairStrandPush push; };

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
    vec4 pointRadius = imageLoad(points, result.point);
    vec4 clip = push.viewProjection * vec4(pointRadius.xyz, 1.0);
    // Derivative of the projected position along the tangent, times w squared, in pixels.
    vec4 along = push.viewProjection * vec4(imageLoad(tangents, result.point).xyz, 0.0);
    vec2 direction = (along.xy * clip.w - clip.xy * along.w) * push.size;
    float size = length(direction);
    result.tangent = size > 1e-20 ? direction / size : vec2(1.0, 0.0);
    float w = max(clip.w, 1e-6);
    float width = 2.0 * pointRadius.w * push.widthScale * push.pixelsPerUnit / w;
    float side = (corner & 1u) == 0u ? -1.0 : 1.0;
    float offset = side * 0.5 * (max(width, push.minimumWidth) + push.border);
    result.line = vec2(width, offset);
    vec2 pixels = vec2(-result.tangent.y, result.tangent.x) * offset + push.jitter;
    result.clip = clip + vec4(pixels * 2.0 / push.size * w, 0.0, 0.0);
    return result;
}

#endif
