// Glossy reflection of baked lobes. Specialisation constant 0 chooses the model (kSpecular... in shared/shade_types.h).
// A mirror shows the light field as its lobes have it: reflections are no sharper than alpha 0.02 or the lobes.
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
layout(binding = 9, rgba32f) uniform image2D lit;
layout(push_constant, scalar) uniform Push { SgShadePush push; };
#define SG_TEXELS texels
#define SG_LOBES lobes
#define SG_SPECULAR_TABLE specularTable
#include "sg/frame.glsl"
#include "sg/lobe_fetch.glsl"
#include "sg/specular_models.glsl"

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
    AtlasFrame frame = atlasFrame(frameN.xyz, frameT.xyz, specular.w > 0.0);
    vec3 normal = toFrame(frame, normalAlpha.xyz);
    vec3 view = toFrame(frame, normalize(push.eye - position.xyz));

    SgFootprint footprint = sgFootprint(vec2(frameN.w, frameT.w), push.atlasResolution);
    SgMixture mixture = specularMixtureAt(normalAlpha.w, normal, view);
    vec3 radiance = vec3(0.0);
    for (uint rest = footprint.lobes; rest != 0u; rest &= rest - 1u) {
        SgSample lobe = sgFetch(footprint, uint(findLSB(rest)));
        vec2 response = specularResponse(kModel, mixture, normalAlpha.w, normal, view, lobe.axis, lobe.lambda);
        radiance += lobe.amplitude * (specular.rgb * response.x + f90 * response.y);
    }
    radiance = sgFootprintEmpty(footprint) ? vec3(0.0) : max(radiance, vec3(0.0));
    imageStore(lit, pixel, vec4(imageLoad(lit, pixel).rgb + radiance, 1.0));
}
