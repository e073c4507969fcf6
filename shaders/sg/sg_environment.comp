// Glossy reflection of the distant environment: prefiltered radiance times a visibility ratio from the second SG set.
// Heitz, Hill, McGuire. Combining Analytic Direct Illumination and Stochastic Shadows. 2018 (the ratio)
//
// The lobes hold environment times visibility at the resolution of the light field, so the ratio's numerator is their
// reflection and its denominator the unoccluded environment reflected at the same blur: each of the BRDF's lobes
// widened by the light lobes'. What remains of the ratio is visibility; the unwidened look-up brings back the detail
// that the lobes cannot hold. On rough surfaces both look-ups agree and the lobes alone decide.
// Where the environment is dim, the lobes of a fit say little. The ratio is therefore an estimate (Wiener's): its prior
// is the visibility w of diffuse light with the variance w (1 - w) of something either seen or not, its measurement
// the quotient with a noise of kFitNoise of the mean radiance. Open surfaces (w = 1) keep the full environment.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/sg_specular.h"
#include "shared/shade_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kModel = kSpecularMixture;
layout(binding = 0, rgba32f) uniform readonly image2D positionImage;
layout(binding = 1, rgba32f) uniform readonly image2D frameImage;
layout(binding = 2, rgba32f) uniform readonly image2D tangentImage;
layout(binding = 3, rgba32f) uniform readonly image2D normalImage;
layout(binding = 4, rgba32f) uniform readonly image2D diffuseImage;
layout(binding = 5, rgba32f) uniform readonly image2D specularImage;
layout(binding = 6, rg32ui) uniform readonly uimageBuffer texels;
layout(binding = 7, rgba32ui) uniform readonly uimageBuffer lobes;
layout(binding = 8) uniform sampler2DArray specularTable;
layout(binding = 9, rgba32f) uniform readonly imageBuffer pyramid;
layout(binding = 10, rgba32f) uniform readonly imageBuffer prefiltered;
layout(binding = 11, rgba32f) uniform image2D lit;
layout(push_constant, scalar) uniform Push { SgEnvironmentPush push; };
#define SG_TEXELS texels
#define SG_LOBES lobes
#define SG_SPECULAR_TABLE specularTable
#define ENVIRONMENT_PYRAMID pyramid
#define ENVIRONMENT_PREFILTERED prefiltered
#include "env/environment_lookup.glsl"
#include "sg/frame.glsl"
#include "sg/lobe_fetch.glsl"
#include "sg/specular_models.glsl"

const float kFitNoise = 0.2;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    vec4 position = imageLoad(positionImage, pixel);
    float f90 = imageLoad(diffuseImage, pixel).w;
    vec4 specular = imageLoad(specularImage, pixel);
    if (position.w == 0.0 || (f90 == 0.0 && specular.rgb == vec3(0.0))) {
        return;
    }
    vec4 frameN = imageLoad(frameImage, pixel);
    vec4 frameT = imageLoad(tangentImage, pixel);
    vec4 normalAlpha = imageLoad(normalImage, pixel);
    float alpha = normalAlpha.w;
    AtlasFrame frame = atlasFrame(frameN.xyz, frameT.xyz, specular.w > 0.0);
    vec3 viewWorld = normalize(push.eye - position.xyz);
    vec3 normal = toFrame(frame, normalAlpha.xyz);
    vec3 view = toFrame(frame, viewWorld);

    // Numerator: the lobes' reflection, and how sharp the lobes were that made it.
    SgFootprint footprint = sgFootprint(vec2(frameN.w, frameT.w), push.atlasResolution);
    SgMixture mixture = specularMixtureAt(alpha, normal, view);
    vec3 reflected = vec3(0.0);
    vec3 irradiance = vec3(0.0);
    float inverseSharpness = 0.0;
    float total = 1e-20;
    for (uint rest = footprint.lobes; rest != 0u; rest &= rest - 1u) {
        SgSample lobe = sgFetch(footprint, uint(findLSB(rest)));
        vec2 response = specularResponse(kModel, mixture, alpha, normal, view, lobe.axis, lobe.lambda);
        reflected += lobe.amplitude * (specular.rgb * response.x + f90 * response.y);
        irradiance += lobe.amplitude * sgIrradiance(lobe.lambda, clamp(dot(lobe.axis, normal), -1.0, 1.0));
        float weight = max(dot(lobe.amplitude, vec3(1.0)), 0.0) * (response.x + response.y);
        inverseSharpness += weight / max(lobe.lambda, 1e-3);
        total += weight;
    }
    if (sgFootprintEmpty(footprint)) {
        return;
    }
    float widening = inverseSharpness / total;

    // The unoccluded environment over the BRDF's lobes, as they are and widened.
    vec3 normalWorld = normalAlpha.xyz;
    SgMeanLobes lobesWorld = specularMeanLobesAt(alpha, normalWorld, viewWorld);
    float wideMean = mixture.bias / max(mixture.scale + mixture.bias, 1e-20);
    vec3 sharp = vec3(0.0);
    vec3 blurred = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
        vec3 axis = lobesWorld.axis[k];
        float sharpness = lobesWorld.sharpness[k];
        float schlick = lobeSchlickWeight(wideMean, viewWorld, normalWorld, axis, sharpness);
        vec3 color = mix(specular.rgb, vec3(f90), schlick) * (lobesWorld.weight[k] * (mixture.scale + mixture.bias));
        sharp += color * prefilteredRadiance(push.environment, axis, sharpness);
        float widened = 1.0 / (1.0 / max(sharpness, 1e-3) + widening);
        blurred += color * prefilteredRadiance(push.environment, axis, widened);
    }

    // Visibility of diffuse light: the cosine is nearly an SG of sharpness 2.133 (sgIrradianceWang).
    vec3 mean = prefilteredRadiance(push.environment, normalWorld, 2.133);
    vec3 diffuseVisibility = clamp(irradiance / max(kPi * mean, vec3(1e-6)), 0.0, 1.0);
    vec3 denominator = max(blurred, vec3(1e-6));
    vec3 noise = kFitNoise * mean * (specular.rgb * mixture.scale + f90 * mixture.bias) / denominator;
    vec3 variance = diffuseVisibility * (1.0 - diffuseVisibility) + 0.01; // the estimate of w has an error too
    vec3 gain = variance / (variance + noise * noise + 1e-12);
    vec3 ratio = mix(diffuseVisibility, clamp(reflected / denominator, 0.0, 1.0), gain);
    vec3 radiance = sharp * ratio;
    imageStore(lit, pixel, vec4(imageLoad(lit, pixel).rgb + radiance, 1.0));
}
