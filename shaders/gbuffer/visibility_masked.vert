// Positions and texture coordinates, for scenes with alpha masks.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/gbuffer_types.h"

layout(binding = 0, rgba32ui) uniform readonly uimageBuffer triangles;
layout(binding = 1, rgba32ui) uniform readonly uimageBuffer corners;
layout(push_constant, scalar) uniform Push { VisibilityPush push; };
layout(constant_id = 0) const uint kSecondTexCoord = 0u;
#define SCENE_CORNERS corners
#include "gbuffer/vertex_pull.glsl"
layout(location = 0) flat out uint slot;
layout(location = 1) flat out uint material;
layout(location = 2) out vec4 texCoords;

void main()
{
    uvec4 corner = imageLoad(triangles, gl_VertexIndex);
    slot = uint(gl_VertexIndex) / 3u;
    material = imageLoad(triangles, int(3u * slot + 1u)).w;
    texCoords = vec4(uintBitsToFloat(imageLoad(corners, gl_VertexIndex).yz), vec2(0.0));
    if (kSecondTexCoord != 0u) {
        texCoords.zw = secondTexCoord(slot, uint(gl_VertexIndex) % 3u, push.triangleCount);
    }
    gl_Position = push.viewProjection * vec4(uintBitsToFloat(corner.xyz), 1.0);
}
