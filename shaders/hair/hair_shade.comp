// Strand points under a light without shadows.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/shade.glsl"

float lightVisibility(HairLight light, vec3 position, vec3 towards, uint point)
{
    return 1.0;
}
