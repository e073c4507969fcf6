// Depth of strands as a light sees them, through the same random masks: a stochastic shadow map.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand_mask.glsl"

layout(location = 0) flat in uvec2 ids;
layout(location = 1) noperspective in vec2 line;

void main()
{
    uint mask = strandMask(ids, line.x);
    if (mask == 0u) {
        discard;
    }
    gl_SampleMask[0] = int(mask);
}
