// The kernels behind convolutions and transposed convolutions. A transposed convolution is the
// data gradient of a convolution and the other way round, so four passes share one function; both
// weight gradients share one correlation.
#pragma once

#include <optional>
#include <string_view>

#include "compute_nn/conv_desc.hpp"
#include "compute_nn/tensor.hpp"

namespace strandlight {

struct Correlation;
class HalfGuard;
struct TileList;

// Weights, bias or their gradients inside a block of floats.
struct LayerWeights
{
    BufferId block;
    std::uint32_t weightOffset = 0;
    std::uint32_t biasOffset = 0;
    bool hasBias = true;
};

// What a data gradient does besides the sum.
struct BackwardEpilogue
{
    bool accumulate = false; // add to what the gradient tensor holds
    std::optional<TensorId>
        activated; // multiply by (activated > 0 ? 1 : slope): back through x's leaky relu
    float slope = 1.0f;
    std::uint32_t firstInput =
        0; // dX holds the channels of x from here on; 0 and all: the whole of x
};

// One convolution or transposed convolution, as forwardPass() and the layers make it.
struct ConvPass
{
    bool transposed = false;
    Extent2 kernel, stride, padding;
    std::uint32_t weightStrideOut = 0; // floats between neighbouring channels of the result
    std::uint32_t weightStrideIn = 0;  // of the source
    float slope = 1.0f;
    bool bias = false;
    BackwardEpilogue backward;
    bool turned = false;             // the kernel is turned about: its last tap is the first
    const TileList* tiles = nullptr; // null: the whole result
    HalfGuard* guard = nullptr;      // of a result of halves
};
// Chooses the kernel by the table of conv_tiles.cpp.
TensorId addConvPass(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                     const TensorId& source, const LayerWeights& weights, const TensorId& result);

BufferId addCorrelationPass(RenderGraph& graph, std::string_view name,
                            const Correlation& correlation, const LayerWeights& gradient);

// bias gradient[c] += sum over n,y,x of dY[n,c,y,x]
BufferId addChannelSumPass(RenderGraph& graph, std::string_view name, const TensorId& dY,
                           const LayerWeights& gradient);

} // namespace strandlight
