// The samples of the features and shape images as planes of floats: what the filter network reads.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DMS features; // brightness, illumination, transparency, depth
layout(binding = 1) uniform sampler2DMS shape;    // tangent
layout(binding = 2) uniform sampler2D exact;      // transmittance
layout(binding = 3, scalar) buffer Planes { float planes[]; };
layout(push_constant, scalar) uniform Push { HairInputPush push; };

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    uint plane = push.width * push.height;
    uint at = uint(pixel.y) * push.width + uint(pixel.x);
    for (int s = 0; s < 4; ++s) {
        vec4 value = texelFetch(features, pixel, s);
        vec2 tangent = texelFetch(shape, pixel, s).xy;
        float depth = value.z < 0.5 ? (value.w - push.depthOffset) * push.depthScale : 0.0;
        uint first = uint(s) * plane + at;
        planes[first] = value.x;
        planes[first + 4u * plane] = value.y;
        planes[first + 8u * plane] = value.z;
        planes[first + 12u * plane] = depth;
        planes[first + 16u * plane] = tangent.x;
        planes[first + 20u * plane] = tangent.y;
    }
    planes[24u * plane + at] = texelFetch(exact, pixel, 0).x;
}
