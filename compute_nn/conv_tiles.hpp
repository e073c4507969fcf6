// Which kernel and register tile a convolution gets: one table per class of device.
#pragma once

#include <cstdint>

#include "compute_nn/conv_desc.hpp"

namespace strandlight {

// Register tile of conv_rows.comp and conv_transpose_rows.comp; where channels are dealt to lanes,
// of conv_channels.comp and conv_transpose_channels.comp.
struct RowTile
{
    std::uint32_t channels;  // at most; blocks of output channels are made equal
    std::uint32_t columns;   // of the grid (conv_rows.glsl)
    std::uint32_t turn;      // input channels per loop turn, at most
    bool splitRows = false;  // transposed: an invocation computes one row phase, not all
    bool minimal = false;    // by minimal_filter.h: three taps a row, stride 1
    std::uint32_t rows = 1;  // of the grid
    std::uint32_t lanes = 1; // that share a block of channels
};

struct RowShape
{
    bool transposed;
    Extent2 kernel;
    Extent2 stride;
    friend bool operator==(const RowShape&, const RowShape&) = default;
};

// Null: no row kernel pays, the gather (conv.comp) takes it. `cpu` is Context::cpuForms(). One
// image never goes to the gather when the table has its shape, so that a list of tiles gives the
// bits of the whole.
const RowTile* findRowTile(bool cpu, const RowShape& shape, std::uint32_t gridWidth,
                           std::uint32_t images);

// For conv_channels.comp and conv_transpose_channels.comp, which take a layer of such a shape if
// its size suits (conv_channels.hpp, which also says of how many channels a tile is).
const RowTile* findChannelTile(bool cpu, const RowShape& shape);

} // namespace strandlight
