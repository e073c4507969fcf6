// Visibility of strand points in one direction, added to its mean and first moment over the sphere.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) uniform readonly imageBuffer points;
layout(binding = 1, rgba32f) uniform imageBuffer openness;
layout(binding = 2, scalar) readonly buffer Lights { HairLight lights[]; };
layout(binding = 3) uniform sampler2DMS shadowMap;
layout(push_constant, scalar) uniform Push { HairOpenPush push; };
#include "hair/shadow_map.glsl"

void main()
{
    int point = int(gl_GlobalInvocationID.x);
    if (point >= int(push.pointCount)) {
        return;
    }
    HairLight along = lights[push.light];
    vec3 position = imageLoad(points, point).xyz - along.shadowBias * along.direction;
    float visible = shadowMapVisibility(along, position, 1, push.shadowSize) / float(kHairOpenDirections);
    vec4 sum = push.first != 0u ? vec4(0.0) : imageLoad(openness, point);
    imageStore(openness, point, sum + visible * vec4(-along.direction, 1.0));
}
