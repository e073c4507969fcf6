// The samples of the features and shape images as planes of floats: what the filter network reads. Past the picture's
// border, up to the size that the network takes, the planes say "no hair".
// VARIANT half RESULT_HALF
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "nn/elements.glsl"
#include "shared/hair_types.h"
#include "nn/nn_math.glsl"
#include "nn/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint TILES = 0; // 1: over a list of tiles

layout(binding = 0) uniform sampler2DMS features; // brightness, illumination, transparency, depth
layout(binding = 1) uniform sampler2DMS shape;    // tangent
layout(binding = 2, scalar) writeonly buffer Planes { RESULT_ELEMENT planes[]; };
layout(binding = 3, r32ui) uniform readonly uimageBuffer tiles;
layout(binding = 4, rgba32f) uniform readonly image2D blended; // premultiplied radiance, transmittance
layout(push_constant, scalar) uniform Push { HairInputPush push; };

void main()
{
    ivec2 pixel = TILES == 0u ? ivec2(gl_GlobalInvocationID.xy) : tilePixel(imageLoad(tiles, int(gl_WorkGroupID.x)).x);
    if (pixel.x >= int(push.planes.width) || pixel.y >= int(push.planes.height)) {
        return;
    }
    uint plane = push.planes.width * push.planes.height;
    uint at = push.planes.offset + uint(pixel.y) * push.planes.width + uint(pixel.x);
    ivec2 from = ivec2(pixel.x, pixel.y + int(push.firstRow));
    bool inside = from.x < int(push.width) && from.y < int(push.height);
    from = inside ? from : ivec2(0);
    for (int s = 0; s < 4; ++s) {
        vec4 value = inside ? texelFetch(features, from, s) : vec4(0.0, 0.0, 1.0, 0.0);
        // The tangent's sign says where the root is, which must not matter: the double angle. (0,0) without hair.
        vec2 along = inside ? texelFetch(shape, from, s).xy : vec2(0.0);
        uint first = at + uint(s) * plane;
        planes[first] = RESULT_ELEMENT(nnLog1p(value.x < 0.0 ? 0.0 : value.x));
        planes[first + 4u * plane] = RESULT_ELEMENT(value.y);
        planes[first + 8u * plane] = RESULT_ELEMENT(value.z);
        planes[first + 12u * plane] = RESULT_ELEMENT(value.z < 0.5 ? (value.w - push.depthOffset) * push.depthScale : 0.0);
        planes[first + 16u * plane] = RESULT_ELEMENT(along.x * along.x - along.y * along.y);
        planes[first + 20u * plane] = RESULT_ELEMENT(2.0 * along.x * along.y);
    }
    vec4 mean = inside ? imageLoad(blended, from) : vec4(0.0, 0.0, 0.0, 1.0);
    planes[at + kHairInputExact * plane] = RESULT_ELEMENT(mean.a);
    planes[at + kHairInputBlended * plane] = RESULT_ELEMENT(nnLog1p(dot(mean.rgb, vec3(0.2126, 0.7152, 0.0722))));
}
