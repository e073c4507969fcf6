// Loss value and gradient. Twin: reference/loss.hpp
#pragma once

#include <optional>
#include <string_view>

#include "compute_nn/loss_kind.hpp"
#include "compute_nn/tensor.hpp"

namespace strandlight {

// Element i of the prediction has weight weights[i / stride % count].
struct LossWeights
{
    BufferId buffer; // [count]
    std::uint32_t count = 1;
    std::uint32_t stride = 1;
};

struct LossResult
{
    BufferId value;    // [1]
    TensorId gradient; // of the prediction, overwritten
};

// prediction, target [N,C,H,W], whole tensors; value = mean of weight x loss over all elements,
// fixed order of summation.
LossResult addLossPass(RenderGraph& graph, std::string_view name, LossKind kind,
                       const TensorId& prediction, const TensorId& target,
                       const std::optional<LossWeights>& weights = std::nullopt);

} // namespace strandlight
