// Per sample what the filter network reads: six values, and the colour for a plain average.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand_mask.glsl"

layout(location = 0) flat in uvec2 ids;
layout(location = 1) noperspective in vec2 line;
layout(location = 2) centroid in vec4 light; // of a sliver, the pixel's middle may lie far outside
layout(location = 3) noperspective in vec2 tangent;
layout(location = 0) out vec4 color;    // radiance, 1: hair
layout(location = 1) out vec4 features; // brightness, illumination, transparency, depth in metres
layout(location = 2) out vec4 shape;    // tangent in the picture, 0, 0

void main()
{
    uint mask = strandMask(ids, line.x);
    if (mask == 0u) {
        discard;
    }
    gl_SampleMask[0] = int(mask);
    color = vec4(light.rgb, 1.0);
    features = vec4(dot(light.rgb, vec3(0.2126, 0.7152, 0.0722)), light.w, 0.0, 1.0 / gl_FragCoord.w);
    // The ends' tangents may cancel between them.
    float size = length(tangent);
    shape = vec4(size > 1e-6 ? tangent / size : vec2(1.0, 0.0), 0.0, 0.0);
}
