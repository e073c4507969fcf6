// Transmittance of one strand through a pixel, to be multiplied: no noise.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand_mask.glsl"
#include "shared/hair_coverage.h"

layout(location = 0) flat in uvec2 ids;
layout(location = 1) noperspective in vec2 line;
layout(location = 2) noperspective in vec2 across;
layout(location = 0) out float transmittance;

void main()
{
    transmittance = 1.0 - push.alpha * hairStripArea(line.x, line.y, normalize(across));
}
