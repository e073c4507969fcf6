#include "compute_nn/conv_transpose2d.hpp"

#include <string>

#include "compute_nn/activation.hpp"
#include "compute_nn/conv_weight_forms.hpp"
#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"

namespace strandlight {

namespace {

void checkShapes(std::string_view name, const ConvTranspose2dDesc& desc, const TensorDesc& x,
                 const TensorDesc& y)
{
    const TensorDesc wanted = desc.output(x, std::string(name));
    if (wanted != y)
        throw Error(std::string(name) + ": the output is " + shapeText(y) + ", the input " +
                    shapeText(x) + " gives " + shapeText(wanted));
}

} // namespace

TensorId convTranspose2dForward(RenderGraph& graph, std::string_view name,
                                const ConvTranspose2dDesc& desc, const TensorId& x,
                                const LayerWeights& weights, const TensorId& y,
                                const Activation& activation, const TileList* tiles,
                                HalfGuard* guard)
{
    checkShapes(name, desc, x.desc, y.desc);
    const std::uint32_t taps = desc.kernel.h * desc.kernel.w;
    return addConvPass(graph, name,
                       {.transposed = true,
                        .kernel = desc.kernel,
                        .stride = desc.stride,
                        .padding = desc.padding,
                        .weightStrideOut = taps,
                        .weightStrideIn = desc.out * taps,
                        .slope = fusedSlope(activation),
                        .bias = weights.hasBias,
                        .backward = {},
                        .tiles = tiles,
                        .guard = guard},
                       x, weights, y);
}

TensorId convTranspose2dBackwardInput(RenderGraph& graph, std::string_view name,
                                      const ConvTranspose2dDesc& desc, const TensorId& dY,
                                      const LayerWeights& weights, const TensorId& dX,
                                      const BackwardEpilogue& epilogue)
{
    TensorDesc whole = dX.desc;
    whole.c = desc.in;
    checkShapes(name, desc, whole, dY.desc);
    STRANDLIGHT_ASSERT(epilogue.firstInput + dX.desc.c <= desc.in);
    const std::uint32_t taps = desc.kernel.h * desc.kernel.w;
    LayerWeights range = weights;
    range.weightOffset += epilogue.firstInput * desc.out * taps;
    return addConvPass(graph, name,
                       {.kernel = desc.kernel,
                        .stride = desc.stride,
                        .padding = desc.padding,
                        .weightStrideOut = desc.out * taps,
                        .weightStrideIn = taps,
                        .backward = epilogue},
                       dY, range, dX);
}

BufferId convTranspose2dBackwardWeight(RenderGraph& graph, std::string_view name,
                                       const ConvTranspose2dDesc& desc, const TensorId& x,
                                       const TensorId& dY, const LayerWeights& gradient)
{
    checkShapes(name, desc, x.desc, dY.desc);
    LayerWeights to = gradient;
    to.block = addCorrelationPass(graph, name, {desc.kernel, desc.stride, desc.padding, x, dY}, to);
    if (to.hasBias)
        to.block = addChannelSumPass(graph, std::string(name) + " bias", dY, to);
    return to.block;
}

} // namespace strandlight
