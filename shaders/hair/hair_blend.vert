// Segments with the radiance and depth of both ends: their fragments interpolate within the segment, never beyond it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/segment.glsl"

layout(binding = 3, rgba32f) uniform readonly imageBuffer shaded;
layout(location = 0) noperspective out vec3 place;
layout(location = 1) flat out vec3 extent;
layout(location = 2) flat out vec4 first; // radiance, depth in metres of the end towards the root
layout(location = 3) flat out vec4 second;

void main()
{
    SegmentVertex vertex = segmentVertex(uint(gl_VertexIndex));
    place = vertex.place;
    extent = vertex.extent;
    first = vec4(imageLoad(shaded, vertex.first).rgb, clipOf(vertex.first).w);
    second = vec4(imageLoad(shaded, vertex.first + 1).rgb, clipOf(vertex.first + 1).w);
    gl_Position = vertex.clip;
}
