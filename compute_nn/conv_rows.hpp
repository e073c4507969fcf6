// The sliding-window kernels of conv_passes.hpp; internal to it.
#pragma once

#include "compute_nn/conv_passes.hpp"
#include "compute_nn/conv_tiles.hpp"

namespace strandlight {

// As addConvPass, by conv_rows.comp or conv_transpose_rows.comp with this register tile.
TensorId addRowConvPass(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                        const RowTile& tile, const TensorId& source, const LayerWeights& weights,
                        const TensorId& result);

} // namespace strandlight
