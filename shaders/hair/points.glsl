// Strand points as vertex shaders see them.
#ifndef STRANDLIGHT_HAIR_POINTS_GLSL
#define STRANDLIGHT_HAIR_POINTS_GLSL

#include "shared/hair_types.h"

layout(binding = 0, rgba32f) uniform readonly imageBuffer points;
layout(binding = 1, rgba32f) uniform readonly imageBuffer tangents;
layout(binding = 2, rg32ui) uniform readonly uimageBuffer segments;
layout(push_constant, scalar) uniform Push { HairStrandPush push; };

vec4 clipOf(int point)
{
    return push.viewProjection * vec4(imageLoad(points, point).xyz, 1.0);
}

// True width in pixels at the point's clip w.
float pixelWidth(int point, float w)
{
    return 2.0 * imageLoad(points, point).w * push.widthScale * push.pixelsPerUnit / w;
}

// Unit tangent in the picture, y down.
vec2 pictureTangent(int point, vec4 clip)
{
    // Derivative of the projected position along the tangent, times w squared, in pixels.
    vec4 along = push.viewProjection * vec4(imageLoad(tangents, point).xyz, 0.0);
    vec2 direction = (along.xy * clip.w - clip.xy * along.w) * push.size;
    float size = length(direction);
    return size > 1e-20 ? direction / size : vec2(1.0, 0.0);
}

#endif
