// Radiance of all strands, weighted by their alpha and by how far in front they are: a mean without noise, where the
// samples have noise and no bias. In hair of one density the weight is what the hair before it lets through; of two
// weights, one suits dense hair and one sparse hair.
// McGuire, Bavoil. Weighted Blended Order-Independent Transparency. 2013
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand_mask.glsl"

layout(location = 0) noperspective in vec3 line;
layout(location = 1) flat in vec4 first;
layout(location = 2) flat in vec4 second;
layout(location = 0) out vec4 near; // radiance times weight, weight: to be added
layout(location = 1) out vec2 deep; // brightness and weight that fall more slowly

void main()
{
    float halfWidth = 0.5 * max(line.x, push.minimumWidth);
    float covered = clamp(halfWidth + 0.5 - abs(line.y), 0.0, 1.0);
    vec4 here = mix(first, second, clamp(line.z, 0.0, 1.0));
    float alpha = strandAlpha(line.x) * covered;
    float depth = (here.w - push.blendDepth) * push.blendScale;
    float weight = alpha * exp(-kHairBlendNear * depth);
    near = vec4(here.rgb * weight, weight);
    weight = alpha * exp(-kHairBlendDeep * depth);
    deep = vec2(dot(here.rgb, vec3(0.2126, 0.7152, 0.0722)) * weight, weight);
}
