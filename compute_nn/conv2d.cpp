#include "compute_nn/conv2d.hpp"

#include <string>

#include "compute_nn/activation.hpp"
#include "compute_nn/conv_weight_forms.hpp"
#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"

namespace strandlight {

namespace {

void checkShapes(std::string_view name, const Conv2dDesc& desc, const TensorDesc& x,
                 const TensorDesc& y)
{
    const TensorDesc wanted = desc.output(x, std::string(name));
    if (wanted != y)
        throw Error(std::string(name) + ": the output is " + shapeText(y) + ", the input " +
                    shapeText(x) + " gives " + shapeText(wanted));
}

} // namespace

ConvPass forwardPass(const Conv2dDesc& desc, bool bias, const Activation& activation,
                     const TileList* tiles, HalfGuard* guard)
{
    const std::uint32_t taps = desc.kernel.h * desc.kernel.w;
    return {.kernel = desc.kernel,
            .stride = desc.stride,
            .padding = desc.padding,
            .weightStrideOut = desc.in * taps,
            .weightStrideIn = taps,
            .slope = fusedSlope(activation),
            .bias = bias,
            .backward = {},
            .tiles = tiles,
            .guard = guard};
}

TensorId conv2dForward(RenderGraph& graph, std::string_view name, const Conv2dDesc& desc,
                       const TensorId& x, const LayerWeights& weights, const TensorId& y,
                       const Activation& activation, const TileList* tiles, HalfGuard* guard)
{
    checkShapes(name, desc, x.desc, y.desc);
    return addConvPass(graph, name, forwardPass(desc, weights.hasBias, activation, tiles, guard), x,
                       weights, y);
}

TensorId conv2dBackwardInput(RenderGraph& graph, std::string_view name, const Conv2dDesc& desc,
                             const TensorId& dY, const LayerWeights& weights, const TensorId& dX,
                             const BackwardEpilogue& epilogue)
{
    TensorDesc whole = dX.desc;
    whole.c = desc.in;
    checkShapes(name, desc, whole, dY.desc);
    STRANDLIGHT_ASSERT(epilogue.firstInput + dX.desc.c <= desc.in);
    const std::uint32_t taps = desc.kernel.h * desc.kernel.w;
    LayerWeights range = weights;
    range.weightOffset += epilogue.firstInput * taps;
    return addConvPass(graph, name,
                       {.transposed = true,
                        .kernel = desc.kernel,
                        .stride = desc.stride,
                        .padding = desc.padding,
                        .weightStrideOut = taps,
                        .weightStrideIn = desc.in * taps,
                        .backward = epilogue},
                       dY, range, dX);
}

BufferId conv2dBackwardWeight(RenderGraph& graph, std::string_view name, const Conv2dDesc& desc,
                              const TensorId& x, const TensorId& dY, const LayerWeights& gradient)
{
    checkShapes(name, desc, x.desc, dY.desc);
    LayerWeights to = gradient;
    to.block = addCorrelationPass(graph, name, {desc.kernel, desc.stride, desc.padding, dY, x}, to);
    if (to.hasBias)
        to.block = addChannelSumPass(graph, std::string(name) + " bias", dY, to);
    return to.block;
}

} // namespace strandlight
