// Pixels of a TileList (compute_nn/tile_list.hpp) for workgroups of 8x8, a tile each.
#ifndef STRANDLIGHT_NN_TILES_GLSL
#define STRANDLIGHT_NN_TILES_GLSL

#include "shared/nn_types.h"

ivec2 tilePixel(uint tile)
{
    return ivec2(tile & 0xffffu, tile >> 16) * int(kTileSide) + ivec2(gl_LocalInvocationID.xy);
}

#endif
