// Colour and coverage of strands, for pictures that are only averaged.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand_mask.glsl"

layout(location = 0) flat in uvec2 ids;
layout(location = 1) noperspective in vec2 line;
layout(location = 2) centroid in vec4 light; // of a sliver, the pixel's middle may lie far outside
layout(location = 0) out vec4 color; // radiance, 1: hair

void main()
{
    uint mask = strandMask(ids, line.x);
    if (mask == 0u) {
        discard;
    }
    gl_SampleMask[0] = int(mask);
    color = vec4(light.rgb, 1.0);
}
