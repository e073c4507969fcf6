// Active tiles of a picture: layers that are given a list compute these and leave the rest as it
// is.
#pragma once

#include "compute_nn/conv_desc.hpp"
#include "compute_nn/tensor.hpp"

namespace strandlight {

// Of one image, in tiles of kConvTileWidth x kConvTileHeight pixels of the layer's output; a layer
// of another size needs its own list. Both buffers are filled on the device.
struct TileList
{
    BufferId tiles;     // uint [count]: x | y << 16, in tiles, each at most once
    BufferId arguments; // uint [kConvTileBlocks][3]: (count, b, 1) for b = 1, 2, ...
};

// Tiles of a picture, the last ones cut by its border.
inline Extent2 tileGrid(const TensorDesc& y)
{
    return {(y.h + gpu::kConvTileHeight - 1) / gpu::kConvTileHeight,
            (y.w + gpu::kConvTileWidth - 1) / gpu::kConvTileWidth};
}

} // namespace strandlight
