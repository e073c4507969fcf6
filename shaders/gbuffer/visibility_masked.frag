// As visibility.frag, without the texels that an alpha mask cuts away.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(binding = 2, rgba32f) uniform readonly imageBuffer materials;
layout(binding = 3, r32ui) uniform readonly uimageBuffer textureWords;
#define STRANDLIGHT_TEXTURE_WORD(i) imageLoad(textureWords, int(i)).x
#define STRANDLIGHT_MATERIAL_TEXEL(i) imageLoad(materials, int(i))
#include "lib/textures.glsl"

layout(location = 0) flat in uint slot;
layout(location = 1) flat in uint material;
layout(location = 2) in vec4 texCoords;
layout(location = 0) out uint visible;

void main()
{
    float cutoff = imageLoad(materials, int(material * kMaterialTexels + 3u)).z;
    if (cutoff >= 0.0 && evaluateAlpha(material, texCoords.xy, texCoords.zw) < cutoff) {
        discard;
    }
    visible = slot + 1u;
}
