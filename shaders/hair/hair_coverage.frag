// Transmittance of one strand through a pixel, to be multiplied: no noise. The ribbon is a pixel wider than the
// strand, and a box of one pixel slides across its edge.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand_mask.glsl"

layout(location = 0) flat in uvec2 ids;
layout(location = 1) noperspective in vec2 line;
layout(location = 0) out float transmittance;

void main()
{
    float halfWidth = 0.5 * max(line.x, push.minimumWidth);
    float covered = clamp(halfWidth + 0.5 - abs(line.y), 0.0, 1.0);
    transmittance = 1.0 - strandAlpha(line.x) * covered;
}
