// Convolution as passes of a graph: forward, and the gradients of input, weight and bias. Twin:
// reference/conv2d.hpp
#pragma once

#include "compute_nn/activation_kind.hpp"
#include "compute_nn/conv_passes.hpp"
#include "compute_nn/tile_list.hpp"

namespace strandlight {

// The forward pass of a layer, for addConvPass: of all its input channels, or of a range of them.
ConvPass forwardPass(const Conv2dDesc& desc, bool bias, const Activation& activation = {},
                     const TileList* tiles = nullptr, HalfGuard* guard = nullptr);

// x [N,I,H,W], weight [O,I,Kh,Kw], bias [O] -> y [N,O,Oh,Ow] = activation(conv(x) + bias),
// overwritten; with tiles (N = 1) only in those. Of the activations, None, Relu and LeakyRelu can
// be fused. Throws Error when shapes do not fit.
TensorId conv2dForward(RenderGraph& graph, std::string_view name, const Conv2dDesc& desc,
                       const TensorId& x, const LayerWeights& weights, const TensorId& y,
                       const Activation& activation = {}, const TileList* tiles = nullptr,
                       HalfGuard* guard = nullptr);

// dY [N,O,Oh,Ow] (before the activation) -> dX [N,I,H,W].
TensorId conv2dBackwardInput(RenderGraph& graph, std::string_view name, const Conv2dDesc& desc,
                             const TensorId& dY, const LayerWeights& weights, const TensorId& dX,
                             const BackwardEpilogue& epilogue = {});

// dY -> accumulates into the weight gradient [O,I,Kh,Kw] and bias gradient [O]. Saved: x.
BufferId conv2dBackwardWeight(RenderGraph& graph, std::string_view name, const Conv2dDesc& desc,
                              const TensorId& x, const TensorId& dY, const LayerWeights& gradient);

} // namespace strandlight
