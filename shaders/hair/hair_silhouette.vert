// Ribbons alone: shadow maps.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand.glsl"

layout(location = 0) flat out uvec2 ids;
layout(location = 1) noperspective out vec2 line;

void main()
{
    RibbonVertex vertex = ribbonVertex(uint(gl_VertexIndex));
    ids = vertex.ids;
    line = vertex.line;
    gl_Position = vertex.clip;
}
