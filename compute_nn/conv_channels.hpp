// The kernel of conv_passes.hpp whose lanes are output channels; internal to it.
#pragma once

#include "compute_nn/conv_passes.hpp"
#include "compute_nn/conv_tiles.hpp"

namespace strandlight {

// The tile with which conv_channels.comp takes this layer of a source of floats, or nothing where
// it does not pay: where pixels or channels would fill it badly, and where rows are not whole
// octets of floats. A list of tiles changes nothing, for it must give the bits of the whole.
std::optional<RowTile> channelTileFor(const RenderGraph& graph, const ConvPass& conv,
                                      const TensorDesc& source, const TensorId& result);

// As addConvPass, with that tile.
TensorId addChannelConvPass(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                            const RowTile& tile, const TensorId& source,
                            const LayerWeights& weights, const TensorId& result);

} // namespace strandlight
