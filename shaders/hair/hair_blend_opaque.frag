// Opaque triangles in the blend pass: they change the depth and add nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"

layout(location = 0) out vec4 slices[kHairSlices];
layout(location = 7) out vec4 quarters;

void main()
{
    quarters = vec4(0.0);
    for (uint i = 0u; i < kHairSlices; ++i) {
        slices[i] = vec4(0.0);
    }
}
