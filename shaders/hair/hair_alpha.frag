// Colour and alpha of strands for the device's alpha to coverage: the baseline without random masks.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand_mask.glsl"

layout(location = 0) flat in uvec2 ids;
layout(location = 1) noperspective in vec2 line;
layout(location = 2) centroid in vec4 light;
layout(location = 0) out vec4 color; // radiance, alpha: the device covers so many of the samples

void main()
{
    color = vec4(light.rgb, strandAlpha(line.x));
}
