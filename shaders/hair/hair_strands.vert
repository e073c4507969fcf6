// Ribbons with what their fragments show.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand.glsl"

layout(binding = 3, rgba32f) uniform readonly imageBuffer shaded;
layout(location = 0) flat out uvec2 ids;
layout(location = 1) noperspective out vec2 line;
layout(location = 2) centroid out vec4 light; // radiance, illumination
layout(location = 3) noperspective out vec2 tangent;

void main()
{
    RibbonVertex vertex = ribbonVertex(uint(gl_VertexIndex));
    ids = vertex.ids;
    line = vertex.line;
    tangent = vertex.tangent;
    light = imageLoad(shaded, vertex.point);
    gl_Position = vertex.clip;
}
