// Where no surface is, the environment itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/camera_types.h"
#include "shared/shade_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image2D position;
layout(binding = 1, rgba32f) uniform readonly imageBuffer pyramid;
layout(binding = 2, rgba32f) uniform image2D lit;
layout(push_constant, scalar) uniform Push { SkyPush push; };
#define ENVIRONMENT_PYRAMID pyramid
#include "env/environment_lookup.glsl"

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height) || imageLoad(position, pixel).w > 0.0) {
        return;
    }
    vec3 direction = cameraRayDirection(push.camera, vec2(pixel) + 0.5);
    imageStore(lit, pixel, vec4(pyramidRadiance(push.environment, environmentUv(direction), 0.0), 1.0));
}
