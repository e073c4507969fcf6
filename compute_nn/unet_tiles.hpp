// Which tiles of which layer a picture needs when only some of its pixels matter: a list for every
// layer of a U-Net, each as much wider than the next as that one reads.
#pragma once

#include <string>
#include <vector>

#include "compute_nn/network_shapes.hpp"
#include "compute_nn/tile_list.hpp"

namespace strandlight {

// An output pixel p of the network matters to the pixels [first, end) of a layer at `level` when
// first 2^level - before <= p < end 2^level + after; the same in both directions.
struct TileReach
{
    std::uint32_t level = 0;
    std::uint32_t before = 0;
    std::uint32_t after = 0;
};

struct UNetReach
{
    TileReach y;
    std::vector<TileReach> up;   // [levels]
    std::vector<TileReach> skip; // [levels + 1]; without a head, skip[0] is the input
    TileReach input;
};
UNetReach unetReach(const UNetDesc& net);

struct UNetTiles
{
    TileList y;
    std::vector<TileList> up;
    std::vector<TileList> skip;
    TileList input;
};

// Which pixels matter, in blocks of 8x8: bit i of the low byte is set when column i has one, of the
// next byte for rows.
struct TouchedBlocks
{
    BufferId buffer; // uint [blocks down, blocks across]
    std::uint32_t across = 0;
    std::uint32_t down = 0;
};

// Rows of the picture that a tensor holds, and those of them that matter.
struct TileRows
{
    std::uint32_t tensorRow = 0; // of the picture, the tensor's first
    std::uint32_t firstRow = 0;  // [firstRow, endRow) matter
    std::uint32_t endRow = 0;
};

// One layer's tiles, as its pass is called.
struct LayerTiles
{
    std::string layer;
    std::uint32_t level = 0; // of its output; 0: full size
    BufferId arguments;      // the first of its numbers: active tiles
    std::uint32_t all = 0;
    std::uint64_t work = 0; // multiply-adds of all tiles
};
// In the order in which they run, for an input x [1,in,H,W].
std::vector<LayerTiles> layerTiles(const UNetDesc& net, const TensorDesc& x,
                                   const UNetTiles& tiles);

// Lists of tiles in row-major order, for an input x [1,in,H,W].
UNetTiles addUNetTilesPass(RenderGraph& graph, const UNetDesc& net, const TensorDesc& x,
                           const TouchedBlocks& touched, const TileRows& rows);

} // namespace strandlight
