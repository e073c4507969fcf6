// The kernel of conv_passes.hpp whose lanes are output channels; internal to it.
#pragma once

#include "compute_nn/conv_passes.hpp"
#include "compute_nn/conv_tiles.hpp"

namespace strandlight {

// Whether so many output channels fill the lanes of conv_channels.comp well enough to pay: then a
// CPU device may take 3x3 layers of stride 1 at points (minimal_filter.h), where a pixel depends,
// to rounding, on all that the four of its group read.
bool fillsChannelTile(std::uint32_t channels);

// The tile with which conv_channels.comp takes this layer of a source of floats, or nothing where
// it does not pay: where pixels or channels would fill it badly, and where rows are not whole
// octets of floats. A list of tiles never changes whether sums are taken at points, for it must
// give the bits of the whole.
std::optional<RowTile> channelTileFor(const RenderGraph& graph, const ConvPass& conv,
                                      const TensorDesc& source, const TensorId& result);

// As addConvPass, with that tile.
TensorId addChannelConvPass(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                            const RowTile& tile, const TensorId& source,
                            const LayerWeights& weights, const TensorId& result);

} // namespace strandlight
