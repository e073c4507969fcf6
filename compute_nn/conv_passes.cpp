#include "compute_nn/conv_passes.hpp"

#include <algorithm>
#include <string>

#include "compute_nn/conv_channels.hpp"
#include "compute_nn/conv_rows.hpp"
#include "compute_nn/conv_tiles.hpp"
#include "compute_nn/conv_work.hpp"
#include "compute_nn/tensor_parts.hpp"
#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

// Register tile of conv.comp: K channels x P pixels.
constexpr std::uint32_t kPixelTile = 4;

TensorId addGatherConvPass(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                           const TensorId& source, const LayerWeights& weights,
                           const TensorId& result)
{
    const Extent2 phases = conv.transposed ? conv.stride : Extent2{1, 1};
    const std::uint64_t taps =
        std::uint64_t(divideUp(conv.kernel.h, phases.h)) * divideUp(conv.kernel.w, phases.w);
    const std::uint32_t turn = unroll(source.desc.c, 4);
    checkTripBudget("conv", taps * (source.desc.c / turn + 2) + conv.kernel.h + 1);
    const std::uint32_t channelTile = result.desc.c > 8 ? 16 : result.desc.c > 4 ? 8 : 4;
    const std::uint32_t grid =
        result.desc.n * divideUp(result.desc.h, phases.h) * divideUp(result.desc.w, phases.w);

    PassBuilder pass = graph.addComputePass(name);
    const Binding from = source.binding(pass.read(source.buffer));
    const BufferId parameters = pass.read(weights.block);
    const BufferId to = pass.write(result.buffer);
    const ConvEpilogue epilogue = bindEpilogue(graph, pass, name, conv, from, result);
    gpu::ConvPush push{.source = source.view(),
                       .result = result.view(),
                       .savedOffset = epilogue.savedView.offset,
                       .savedImageStride = epilogue.savedView.imageStride,
                       .inChannels = source.desc.c,
                       .outChannels = result.desc.c,
                       .weightOffset = weights.weightOffset,
                       .weightStrideOut = conv.weightStrideOut,
                       .weightStrideIn = conv.weightStrideIn,
                       .biasOffset = weights.biasOffset,
                       .kernelHeight = conv.kernel.h,
                       .kernelWidth = conv.kernel.w,
                       .strideHeight = conv.stride.h,
                       .strideWidth = conv.stride.w,
                       .paddingHeight = conv.padding.h,
                       .paddingWidth = conv.padding.w,
                       .transposed = conv.transposed ? 1u : 0u,
                       .firstPixel = 0,
                       .endPixel = grid,
                       .slope = epilogue.slope};

    const KernelBlob& kernel =
        variantFor(source, result, kernels::conv, kernels::conv_half, kernels::conv_from_half);

    // Slices of pixels, whole tiles each.
    const std::uint64_t workPerPixel = taps * source.desc.c * result.desc.c * phases.h * phases.w;
    const std::uint32_t tile = kPixelTile * kConvLanes;
    const std::uint32_t slice =
        divideUp(std::max<std::uint64_t>(kDispatchWork / workPerPixel, tile), tile) * tile;
    for (std::uint32_t first = 0; first < grid; first += slice) {
        push.firstPixel = first;
        push.endPixel = std::min(grid, first + slice);
        const std::uint32_t threads = divideUp(push.endPixel - first, tile) * kConvLanes;
        pass.dispatch(kernel, {threads, divideUp(result.desc.c, channelTile), phases.h * phases.w},
                      push, {from, parameters, epilogue.saved, result.binding(to), epilogue.guard},
                      {channelTile, kPixelTile, turn, epilogue.flags});
    }
    return result.as(to);
}

TensorId addBoundConvPass(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                          const TensorId& source, const LayerWeights& weights,
                          const TensorId& result)
{
    STRANDLIGHT_ASSERT_EQ(source.desc.n, result.desc.n);
    if (source.element == Element::Float)
        if (const std::optional<RowTile> tile = channelTileFor(graph, conv, source.desc, result))
            return addChannelConvPass(graph, name, conv, *tile, source, weights, result);
    const std::uint32_t scale = conv.transposed ? conv.stride.w : 1;
    // A transposed kernel that its padding covers has taps beyond any window.
    const bool windowed =
        !conv.transposed || (conv.padding.h < conv.kernel.h && conv.padding.w < conv.kernel.w);
    const RowTile* tile = windowed ? findRowTile(graph.context().cpuForms(),
                                                 {conv.transposed, conv.kernel, conv.stride},
                                                 divideUp(result.desc.w, scale), result.desc.n)
                                   : nullptr;
    if (tile)
        return addRowConvPass(graph, name, conv, *tile, source, weights, result);
    if (conv.tiles)
        throw Error(std::string(name) + ": a kernel of " + std::to_string(conv.kernel.h) + "x" +
                    std::to_string(conv.kernel.w) + ", stride " + std::to_string(conv.stride.w) +
                    ", has no form for tiles");
    return addGatherConvPass(graph, name, conv, source, weights, result);
}

// Images [first, first + count): of one alone, ranges of its channels. Sums over ranges of input
// channels accumulate: bias with the first, activation with the last.
TensorId addConvPassOfImages(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                             const TensorId& source, const LayerWeights& weights, TensorId result,
                             std::uint32_t first, std::uint32_t count)
{
    const bool alone = count == 1;
    const std::uint32_t in = alone ? channelsPerPart(graph, name, source) : source.desc.c;
    std::uint32_t out = alone ? channelsPerPart(graph, name, result) : result.desc.c;
    const std::optional<TensorId>& activated = conv.backward.activated;
    if (alone && activated)
        out = std::min(out, channelsPerPart(graph, name, *activated));
    for (std::uint32_t o = 0; o < result.desc.c; o += out)
        for (std::uint32_t i = 0; i < source.desc.c; i += in) {
            const std::uint32_t outs = std::min(out, result.desc.c - o);
            const std::uint32_t ins = std::min(in, source.desc.c - i);
            const bool last = i + ins == source.desc.c;
            ConvPass part = conv;
            part.bias = conv.bias && i == 0;
            part.slope = last ? conv.slope : 1.0f;
            part.backward.accumulate = conv.backward.accumulate || i > 0;
            part.backward.activated.reset();
            if (last && activated)
                part.backward.activated = boundPart(*activated, first, count, o, outs);
            LayerWeights range = weights;
            range.weightOffset += o * conv.weightStrideOut + i * conv.weightStrideIn;
            range.biasOffset += o;
            result = result.as(addBoundConvPass(graph, name, part,
                                                boundPart(source, first, count, i, ins), range,
                                                boundPart(result, first, count, o, outs))
                                   .buffer);
        }
    return result;
}

} // namespace

TensorId addConvPass(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                     const TensorId& source, const LayerWeights& weights, const TensorId& result)
{
    const TensorId& saved = conv.backward.activated ? *conv.backward.activated : result;
    if (fitBindings(graph, {source, result, saved}))
        return addBoundConvPass(graph, name, conv, source, weights, result);
    const std::uint32_t images = imagesPerPart(graph, {source, result, saved});
    TensorId to = result;
    for (std::uint32_t n = 0; n < result.desc.n; n += images)
        to = addConvPassOfImages(graph, name, conv, source, weights, to, n,
                                 std::min(images, result.desc.n - n));
    return to;
}

} // namespace strandlight
