// Opaque triangles in the coverage pass: they change the depth and no transmittance.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(location = 0) out float transmittance;

void main()
{
    transmittance = 1.0;
}
