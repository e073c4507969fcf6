// Radiance of every strand point towards the camera from one light: points are fewer than fragments, and a shadow
// looked up here is smooth. The includer defines lightVisibility(HairLight, vec3 position, vec3 towards, uint point).
#include "hair/light.glsl"
#include "shared/hair_bsdf.h"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) uniform readonly imageBuffer points;
layout(binding = 1, rgba32f) uniform readonly imageBuffer tangents;
layout(binding = 2, rgba32f) uniform readonly imageBuffer colors;
layout(binding = 3, rgba32f) uniform imageBuffer shaded;
layout(binding = 4, scalar) readonly buffer Lights { HairLight lights[]; };
layout(push_constant, scalar) uniform Push { HairShadePush push; };

float lightVisibility(HairLight light, vec3 position, vec3 towards, uint point);

void main()
{
    uint point = gl_GlobalInvocationID.x;
    if (point >= push.pointCount) {
        return;
    }
    vec3 position = imageLoad(points, int(point)).xyz;
    vec3 tangent = imageLoad(tangents, int(point)).xyz;
    vec3 color = imageLoad(colors, int(point)).rgb;
    // Under the same radiance from everywhere a fibre shows its albedo's share of it.
    vec4 sum = push.first != 0u ? vec4(push.ambient * color, push.lightCount == 0u ? 1.0 : 0.0)
                                : imageLoad(shaded, int(point));
    if (push.light < push.lightCount) {
        HairLight light = lights[push.light];
        vec3 towards;
        vec3 irradiance = hairLightIrradiance(light, position, towards);
        float visible = lightVisibility(light, position, towards, point);
        vec3 view = normalize(push.eye - position);
        vec3 single = hairScatter(tangent, towards, view, color, push.roughness, push.tilt);
        vec3 multiple = hairMultipleScatter(tangent, towards, view, color, visible);
        sum.rgb += irradiance * (single * visible + multiple);
        sum.w += visible * push.share;
    }
    imageStore(shaded, int(point), sum);
}
