// Which pixels strands touch, in blocks of 8x8 (compute_nn/unet_tiles.hpp).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image2D blended; // .a: transmittance; 1: no strand
layout(binding = 1, scalar) writeonly buffer Blocks { uint blocks[]; };
layout(push_constant, scalar) uniform Push { HairTouchedPush push; };

void main()
{
    uvec2 block = gl_GlobalInvocationID.xy;
    if (block.x >= push.blocksAcross || block.y >= push.blocksDown) {
        return;
    }
    uint bits = 0u;
    for (uint i = 0u; i < 64u; ++i) {
        uvec2 pixel = 8u * block + uvec2(i & 7u, i >> 3);
        bool inside = pixel.x < push.width && pixel.y < push.height;
        bool hair = inside && imageLoad(blended, ivec2(inside ? pixel : uvec2(0u))).a != 1.0;
        bits |= hair ? 1u << (i & 7u) | 256u << (i >> 3) : 0u;
    }
    blocks[block.y * push.blocksAcross + block.x] = bits;
}
