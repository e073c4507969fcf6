// Ribbons alone: shadow maps and exact coverage.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand.glsl"

layout(location = 0) flat out uvec2 ids;
layout(location = 1) noperspective out vec2 line;
layout(location = 2) noperspective out vec2 across; // the ribbon's normal in the picture

void main()
{
    RibbonVertex vertex = ribbonVertex(uint(gl_VertexIndex));
    ids = vertex.ids;
    line = vertex.line;
    across = vec2(-vertex.tangent.y, vertex.tangent.x);
    gl_Position = vertex.clip;
}
