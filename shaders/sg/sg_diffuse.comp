// Diffuse light from baked lobes: sum of amplitude times the clamped-cosine integral (shared/sg_diffuse.h), less what
// Fresnel keeps from the base layer, as the path tracer's BRDF has it (shared/brdf.h). Specialisation constant 0 chooses
// the integral (kDiffuse... in shared/shade_types.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/sg_specular.h"
#include "shared/shade_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kModel = kDiffuseTokuyoshi;
layout(binding = 0, rgba32f) uniform readonly image2D positionImage;
layout(binding = 1, rgba32f) uniform readonly image2D frameImage;
layout(binding = 2, rgba32f) uniform readonly image2D tangentImage;
layout(binding = 3, rgba32f) uniform readonly image2D normalImage;
layout(binding = 4, rgba32f) uniform readonly image2D diffuseImage;
layout(binding = 5, rgba32f) uniform readonly image2D specularImage;
layout(binding = 6, rg32ui) uniform readonly uimageBuffer texels;
layout(binding = 7, rgba32ui) uniform readonly uimageBuffer lobes;
layout(binding = 8, rgba32f) uniform image2D lit;
layout(push_constant, scalar) uniform Push { SgShadePush push; };
#define SG_TEXELS texels
#define SG_LOBES lobes
#include "sg/frame.glsl"
#include "sg/lobe_fetch.glsl"

float irradianceOf(float lambda, float cosine)
{
    if (kModel == kDiffuseHill) {
        return sgIrradianceHill(lambda, cosine);
    }
    if (kModel == kDiffuseWang) {
        return sgIrradianceWang(lambda, cosine);
    }
    return sgIrradiance(lambda, cosine);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    vec4 position = imageLoad(positionImage, pixel);
    vec4 diffuse = imageLoad(diffuseImage, pixel);
    if (position.w == 0.0 || diffuse.rgb == vec3(0.0)) {
        return;
    }
    vec4 frameN = imageLoad(frameImage, pixel);
    vec4 frameT = imageLoad(tangentImage, pixel);
    vec4 specular = imageLoad(specularImage, pixel);
    AtlasFrame frame = atlasFrame(frameN.xyz, frameT.xyz, specular.w > 0.0);
    vec3 normal = toFrame(frame, imageLoad(normalImage, pixel).xyz);
    vec3 view = toFrame(frame, normalize(push.eye - position.xyz));
    float largestF0 = max(max(specular.x, specular.y), specular.z);
    float wideMean = diffuseSchlickWeight(dot(normal, view));

    SgFootprint footprint = sgFootprint(vec2(frameN.w, frameT.w), push.atlasResolution);
    vec3 irradiance = vec3(0.0);
    for (uint rest = footprint.lobes; rest != 0u; rest &= rest - 1u) {
        SgSample lobe = sgFetch(footprint, uint(findLSB(rest)));
        float response = irradianceOf(lobe.lambda, clamp(dot(lobe.axis, normal), -1.0, 1.0));
        float schlick = lobeSchlickWeight(wideMean, view, normal, lobe.axis, lobe.lambda);
        float kept = 1.0 - mix(largestF0, diffuse.w, schlick);
        irradiance += lobe.amplitude * (response * kept);
    }
    // Lobes of a fit may be negative in a channel; light is not.
    irradiance = sgFootprintEmpty(footprint) ? vec3(0.0) : max(irradiance, vec3(0.0));
    vec3 before = imageLoad(lit, pixel).rgb;
    imageStore(lit, pixel, vec4(before + diffuse.rgb * irradiance / kPi, 1.0));
}
