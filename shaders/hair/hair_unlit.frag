// Opaque triangles in the blend pass: they change the depth and add nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(location = 0) out vec4 near;
layout(location = 1) out vec2 deep;

void main()
{
    near = vec4(0.0);
    deep = vec2(0.0);
}
