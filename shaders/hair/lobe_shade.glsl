// Radiance of every strand point towards the camera from distant lobes, added up. The includer defines
// lobeVisibility(uint lobe, HairLobe light, vec3 position, int point).
#include "shared/hair_lobe.h"
#include "shared/hair_types.h"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) uniform readonly imageBuffer points;
layout(binding = 1, rgba32f) uniform readonly imageBuffer tangents;
layout(binding = 2, rgba32f) uniform readonly imageBuffer colors;
layout(binding = 3, rgba32f) uniform imageBuffer shaded;
layout(binding = 4, scalar) readonly buffer Lobes { HairLobe lobes[]; };
layout(push_constant, scalar) uniform Push { HairLobePush push; };

float lobeVisibility(uint lobe, HairLobe light, vec3 position, int point);

void main()
{
    int point = int(gl_GlobalInvocationID.x);
    if (point >= int(push.pointCount)) {
        return;
    }
    vec3 position = imageLoad(points, point).xyz;
    vec3 tangent = imageLoad(tangents, point).xyz;
    vec3 color = imageLoad(colors, point).rgb;
    vec3 view = normalize(push.eye - position);
    vec4 sum = push.first != 0u ? vec4(0.0) : imageLoad(shaded, point);
    for (uint lobe = push.lobe; lobe < push.lobe + push.lobeCount; ++lobe) {
        HairLobe light = lobes[lobe];
        float visible = lobeVisibility(lobe, light, position, point);
        vec3 single = hairScatterLobe(tangent, light.axis, light.sharpness, view, color, push.roughness, push.tilt);
        sum.rgb += light.energy * (single * visible + hairScatterOn(color, visible));
        sum.w += visible * light.share;
    }
    imageStore(shaded, point, sum);
}
