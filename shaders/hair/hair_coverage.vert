// Segments as exact coverage draws them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/segment.glsl"

layout(location = 0) noperspective out vec3 place;
layout(location = 1) flat out vec3 extent;

void main()
{
    SegmentVertex vertex = segmentVertex(uint(gl_VertexIndex));
    place = vertex.place;
    extent = vertex.extent;
    gl_Position = vertex.clip;
}
