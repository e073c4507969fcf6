// Transmittance of one segment through a pixel, to be multiplied: no noise.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_coverage.h"
#include "shared/hair_types.h"

layout(location = 0) noperspective in vec3 place; // pixels: width, distances from the middle across and along
layout(location = 1) flat in vec3 extent;         // direction, length
layout(location = 0) out float transmittance;
layout(push_constant, scalar) uniform Push { HairStrandPush push; };

void main()
{
    transmittance = 1.0 - push.alpha * hairRectangleArea(place.x, place.y, extent.z, place.z, extent.xy);
}
