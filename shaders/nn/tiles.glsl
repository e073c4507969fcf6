// Pixels of a TileList (compute_nn/tile_list.hpp) for workgroups of 8x8: record (tiles, kConvTileWidth / 8, 1).
#ifndef STRANDLIGHT_NN_TILES_GLSL
#define STRANDLIGHT_NN_TILES_GLSL

#include "shared/nn_types.h"

ivec2 tilePixel(uint tile)
{
    return ivec2((tile & 0xffffu) * kConvTileWidth + 8u * gl_WorkGroupID.y + gl_LocalInvocationID.x,
                 (tile >> 16) * kConvTileHeight + gl_LocalInvocationID.y);
}

#endif
