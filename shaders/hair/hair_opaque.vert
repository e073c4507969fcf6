// Opaque triangles that hide hair.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"

layout(binding = 0, rgba32f) uniform readonly imageBuffer surface;
layout(binding = 2, rgba32f) uniform readonly imageBuffer visibility;
layout(push_constant, scalar) uniform Push { HairOpaquePush push; };
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 albedo;
layout(location = 3) out vec4 lightShares;

void main()
{
    vec4 corner = imageLoad(surface, 2 * gl_VertexIndex);
    position = corner.xyz;
    normal = imageLoad(surface, 2 * gl_VertexIndex + 1).xyz;
    albedo = unpackUnorm4x8(floatBitsToUint(corner.w)).rgb;
    lightShares = imageLoad(visibility, gl_VertexIndex);
    gl_Position = push.viewProjection * vec4(position, 1.0);
    gl_Position.xy += push.jitter * 2.0 / push.size * gl_Position.w;
}
