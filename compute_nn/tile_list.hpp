// Active tiles of a picture: layers that are given a list compute these and leave the rest as it
// is.
#pragma once

#include <bit>

#include "compute_nn/conv_desc.hpp"
#include "compute_nn/tensor.hpp"

namespace strandlight {

// Of one image, in tiles of kTileSide x kTileSide pixels of the layer's output; a layer of another
// size needs its own list. Both buffers are filled on the device.
struct TileList
{
    // uint [kTilePadding more than the picture has]: x | y << 16, in tiles, each at most once; then
    // up to the next multiple of kTilePadding ~0, a place outside of every picture.
    BufferId tiles;
    BufferId arguments; // uint [kTileShares][kTileBlocks][3], tileArguments() says what
};

inline constexpr std::uint32_t kTilePadding = 1u << (gpu::kTileShares - 1);

// Offset in bytes of the arguments (workgroups, blocks, 1) for workgroups of `share` tiles each, a
// power of two up to kTilePadding. The first of all is the number of tiles.
inline std::uint64_t tileArguments(std::uint32_t share, std::uint32_t blocks)
{
    return (std::uint64_t(std::countr_zero(share)) * gpu::kTileBlocks + blocks - 1) * 12;
}

// Tiles of a picture, the last ones cut by its border.
inline Extent2 tileGrid(const TensorDesc& y)
{
    return {(y.h + gpu::kTileSide - 1) / gpu::kTileSide,
            (y.w + gpu::kTileSide - 1) / gpu::kTileSide};
}

} // namespace strandlight
