// Elementwise passes. Twin: reference/activation.hpp
#pragma once

#include <string_view>

#include "compute_nn/activation_kind.hpp"
#include "compute_nn/tensor.hpp"

namespace strandlight {

// Slope below zero of an activation that convolutions fuse; 1 for None. Throws Error for Softplus
// and Sigmoid.
float fusedSlope(const Activation& activation);

// y = f(x), overwritten; x and y [N,C,H,W], ranges allowed.
TensorId activationForward(RenderGraph& graph, std::string_view name, const Activation& activation,
                           const TensorId& x, const TensorId& y);

// dX += dY f'(x). Saved: y = f(x).
TensorId activationBackward(RenderGraph& graph, std::string_view name, const Activation& activation,
                            const TensorId& y, const TensorId& dY, const TensorId& dX);

// y = x in halves; beyond 65504 it is an infinity or 65504, as the device rounds.
TensorId storeAsHalves(RenderGraph& graph, std::string_view name, const TensorId& x,
                       const TensorId& y);

// y = ln(1 + max(x, 0)): how networks see radiance.
TensorId log1pForward(RenderGraph& graph, std::string_view name, const TensorId& x,
                      const TensorId& y);

} // namespace strandlight
