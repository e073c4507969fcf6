// Positions from the scene's triangles: vertex 3 s + k is corner k of slot s.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/gbuffer_types.h"

layout(binding = 0, rgba32ui) uniform readonly uimageBuffer triangles;
layout(push_constant, scalar) uniform Push { VisibilityPush push; };
layout(location = 0) flat out uint slot;

void main()
{
    uvec4 corner = imageLoad(triangles, gl_VertexIndex);
    slot = uint(gl_VertexIndex) / 3u;
    gl_Position = push.viewProjection * vec4(uintBitsToFloat(corner.xyz), 1.0);
}
