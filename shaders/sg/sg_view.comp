// Looks at the bake itself. Specialisation constant 0: kViewLobes, kViewAtlas or kViewCount (shared/shade_types.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/rng.h"
#include "shared/shade_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kView = kViewLobes;
layout(binding = 0, rgba32f) uniform readonly image2D positionImage;
layout(binding = 1, rgba32f) uniform readonly image2D frameImage;
layout(binding = 2, rgba32f) uniform readonly image2D tangentImage;
layout(binding = 3, rgba32f) uniform readonly image2D normalImage;
layout(binding = 4, rgba32f) uniform readonly image2D specularImage;
layout(binding = 5, rg32ui) uniform readonly uimageBuffer texels;
layout(binding = 6, rgba32ui) uniform readonly uimageBuffer lobes;
layout(binding = 7, rgba32f) uniform image2D lit;
layout(push_constant, scalar) uniform Push { SgShadePush push; };
#define SG_TEXELS texels
#define SG_LOBES lobes
#include "sg/frame.glsl"
#include "sg/lobe_fetch.glsl"

// The light field as a perfect mirror at the surface would show it.
vec3 mirrorRadiance(AtlasFrame frame, vec2 place, vec3 normal, vec3 view)
{
    vec3 direction = toFrame(frame, normal * (2.0 * dot(normal, view)) - view);
    SgFootprint footprint = sgFootprint(place, push.atlasResolution);
    vec3 radiance = vec3(0.0);
    for (uint rest = footprint.lobes; rest != 0u; rest &= rest - 1u) {
        SgSample lobe = sgFetch(footprint, uint(findLSB(rest)));
        radiance += lobe.amplitude * sgEvaluate(direction, lobe.axis, lobe.lambda);
    }
    return sgFootprintEmpty(footprint) ? vec3(0.0) : max(radiance, vec3(0.0));
}

// One colour per texel, light and dark in turn; magenta where the atlas has no surface.
vec3 texelColor(vec2 place)
{
    uvec2 texel = min(uvec2(max(place, vec2(0.0))), uvec2(push.atlasResolution - 1u));
    uint index = imageLoad(SG_TEXELS, int(texel.y * push.atlasResolution + texel.x)).x;
    uvec3 hash = hashPcg3(uvec3(texel / 8u, 1u));
    vec3 color = vec3(uniformFloat(hash.x), uniformFloat(hash.y), uniformFloat(hash.z));
    float checker = ((texel.x + texel.y) & 1u) == 0u ? 1.0 : 0.6;
    return index == kNoTexel ? vec3(1.0, 0.0, 1.0) : color * checker;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    vec4 position = imageLoad(positionImage, pixel);
    if (position.w == 0.0) {
        return;
    }
    vec4 frameN = imageLoad(frameImage, pixel);
    vec4 frameT = imageLoad(tangentImage, pixel);
    vec2 place = vec2(frameN.w, frameT.w);
    vec3 before = imageLoad(lit, pixel).rgb;
    if (kView == kViewAtlas) {
        imageStore(lit, pixel, vec4(texelColor(place), 1.0));
        return;
    }
    if (kView == kViewCount) {
        uint count = bitCount(sgFootprint(place, push.atlasResolution).lobes);
        imageStore(lit, pixel, vec4(vec3(float(count)), 1.0));
        return;
    }
    AtlasFrame frame = atlasFrame(frameN.xyz, frameT.xyz, imageLoad(specularImage, pixel).w > 0.0);
    vec3 view = normalize(push.eye - position.xyz);
    vec3 normal = imageLoad(normalImage, pixel).xyz;
    imageStore(lit, pixel, vec4(before + mirrorRadiance(frame, place, normal, view), 1.0));
}
