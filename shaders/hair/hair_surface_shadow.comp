// How much of one light reaches each corner of the opaque triangles through hair. Corners are few: 7 x 7 texels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/light.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) uniform readonly imageBuffer surface;
layout(binding = 1, rgba32f) uniform imageBuffer visibility;
layout(binding = 2, scalar) readonly buffer Lights { HairLight lights[]; };
layout(binding = 3) uniform sampler2DMS shadowMap;
layout(push_constant, scalar) uniform Push { HairSurfacePush push; };
#include "hair/shadow_map.glsl"

void main()
{
    int corner = int(gl_GlobalInvocationID.x);
    if (corner >= int(push.cornerCount)) {
        return;
    }
    HairLight light = lights[push.light];
    vec3 position = imageLoad(surface, 2 * corner).xyz;
    vec3 normal = imageLoad(surface, 2 * corner + 1).xyz;
    vec3 towards;
    hairLightIrradiance(light, position, towards);
    // Off the surface by more than the texels that are looked at, or it would shadow itself.
    position += light.shadowBias * (towards + 3.0 * normal);
    vec4 shares = imageLoad(visibility, corner);
    shares[push.light] = shadowMapVisibility(light, position, 3, push.shadowSize);
    imageStore(visibility, corner, shares);
}
