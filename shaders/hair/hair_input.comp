// The planes of floats that the filter network reads.
// VARIANT half RESULT_HALF
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "nn/elements.glsl"
#define BLENDED_BINDING 4
#include "hair/network_input.glsl"
#include "nn/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint TILES = 0; // 1: over a list of tiles

layout(binding = 2, scalar) writeonly buffer Planes { RESULT_ELEMENT planes[]; };
layout(binding = 3, r32ui) uniform readonly uimageBuffer tiles;
layout(push_constant, scalar) uniform Push { HairInputPush push; };

void main()
{
    ivec2 pixel = TILES == 0u ? ivec2(gl_GlobalInvocationID.xy) : tilePixel(imageLoad(tiles, int(gl_WorkGroupID.x)).x);
    if (pixel.x >= int(push.planes.width) || pixel.y >= int(push.planes.height)) {
        return;
    }
    uint plane = push.planes.width * push.planes.height;
    uint at = push.planes.offset + uint(pixel.y) * push.planes.width + uint(pixel.x);
    [[unroll]] for (uint part = 0; part < kParts; ++part) {
        float values[kHairPartPlanes];
        networkInput(push.from, pixel, part, values);
        [[unroll]] for (uint i = 0; i < kHairPartPlanes; ++i)
            if (part * kHairPartPlanes + i < kHairInputPlanes)
                planes[at + (part * kHairPartPlanes + i) * plane] = RESULT_ELEMENT(values[i]);
    }
}
