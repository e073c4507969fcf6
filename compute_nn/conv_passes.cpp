#include "compute_nn/conv_passes.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "engine/base/assert.hpp"
#include "kernels.gen.hpp"

namespace strandlight {

namespace {

// Register tiles, measured on lavapipe (README.md): K channels x P pixels of conv.comp.
constexpr std::uint32_t kPixelTile = 4;
// A x 8 channels and B columns of conv_backward_weight.comp.
constexpr std::uint32_t kColumnTile = 32;
constexpr std::uint32_t kLanes = 8;
// Multiply-adds of one dispatch: about 30 ms on two lavapipe threads, so that no dispatch exceeds
// 100 ms.
constexpr std::uint64_t kDispatchWork = std::uint64_t(3) << 28;

std::uint32_t divideUp(std::uint64_t a, std::uint64_t b)
{
    return std::uint32_t((a + b - 1) / b);
}

// Most of 1..limit that divides `count`: loop turns stay equal, with no remainder to test for.
std::uint32_t unroll(std::uint32_t count, std::uint32_t limit)
{
    std::uint32_t best = 1;
    for (std::uint32_t u = 2; u <= limit; ++u)
        if (count % u == 0)
            best = u;
    return best;
}

std::uint32_t shuffleFlag(RenderGraph& graph)
{
    return graph.context().subgroupSize() >= kLanes ? gpu::kConvShuffle : 0;
}

} // namespace

TensorId addGatherConvPass(RenderGraph& graph, std::string_view name, const GatherConv& conv,
                           const TensorId& source, const LayerWeights& weights,
                           const TensorId& result)
{
    STRANDLIGHT_ASSERT_EQ(source.desc.n, result.desc.n);
    const Extent2 phases = conv.transposed ? conv.stride : Extent2{1, 1};
    const std::uint64_t taps =
        std::uint64_t(divideUp(conv.kernel.h, phases.h)) * divideUp(conv.kernel.w, phases.w);
    const std::uint32_t turn = unroll(source.desc.c, 4);
    checkTripBudget("conv", taps * (source.desc.c / turn + 2) + conv.kernel.h + 1);
    const std::uint32_t channelTile = result.desc.c > 8 ? 16 : result.desc.c > 4 ? 8 : 4;
    const std::uint32_t grid =
        result.desc.n * divideUp(result.desc.h, phases.h) * divideUp(result.desc.w, phases.w);

    PassBuilder pass = graph.addComputePass(name);
    const BufferId from = pass.read(source.buffer);
    const BufferId parameters = pass.read(weights.block);
    const BufferId to = pass.write(result.buffer);
    const BackwardEpilogue& epilogue = conv.backward;
    const bool derivative = epilogue.activated.has_value();
    const BufferId saved = derivative ? pass.read(epilogue.activated->buffer) : from;
    const gpu::TensorView savedView = derivative ? epilogue.activated->view() : gpu::TensorView{};
    const std::uint32_t flags = (conv.bias ? gpu::kConvBias : 0) |
                                (epilogue.accumulate ? gpu::kConvAccumulate : 0) |
                                (derivative ? gpu::kConvDerivative : 0) | shuffleFlag(graph);
    gpu::ConvPush push{.source = source.view(),
                       .result = result.view(),
                       .savedOffset = savedView.offset,
                       .savedImageStride = savedView.imageStride,
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
                       .slope = derivative ? epilogue.slope : conv.slope};

    // Slices of pixels, whole tiles each.
    const std::uint64_t workPerPixel = taps * source.desc.c * result.desc.c * phases.h * phases.w;
    const std::uint32_t tile = kPixelTile * kLanes;
    const std::uint32_t slice =
        divideUp(std::max<std::uint64_t>(kDispatchWork / workPerPixel, tile), tile) * tile;
    for (std::uint32_t first = 0; first < grid; first += slice) {
        push.firstPixel = first;
        push.endPixel = std::min(grid, first + slice);
        const std::uint32_t threads = divideUp(push.endPixel - first, tile) * kLanes;
        pass.dispatch(kernels::conv,
                      {threads, divideUp(result.desc.c, channelTile), phases.h * phases.w}, push,
                      {from, parameters, saved, to}, {channelTile, kPixelTile, turn, flags});
    }
    return result.as(to);
}

BufferId addCorrelationPass(RenderGraph& graph, std::string_view name, Extent2 kernel,
                            Extent2 stride, Extent2 padding, const TensorId& small,
                            const TensorId& large, const LayerWeights& gradient)
{
    STRANDLIGHT_ASSERT_EQ(small.desc.n, large.desc.n);
    const std::uint32_t columns = large.desc.c * kernel.h * kernel.w;
    const std::uint32_t elements = small.desc.c * columns;
    const std::uint32_t pixels = small.desc.n * small.desc.pixels();
    const std::uint32_t channelVectors = small.desc.c > kLanes ? 2 : 1;
    const std::uint32_t columnTile = columns > 8 ? kColumnTile : 8;
    const std::uint32_t tilesA = divideUp(small.desc.c, kLanes * channelVectors);
    const std::uint32_t tilesB = divideUp(columns, columnTile);

    // Enough strips to fill the threads, short enough for the trip budget, few enough to keep the
    // strips small.
    const std::uint32_t wanted = std::max(divideUp(256, tilesA * tilesB), divideUp(pixels, 16384));
    const std::uint32_t stripPixels = std::max(divideUp(pixels, wanted), 16u);
    const std::uint32_t strips = divideUp(pixels, stripPixels);
    checkTripBudget("conv_backward_weight", stripPixels / 2 + 1);
    checkTripBudget("strip_sum", strips);

    PassBuilder pass = graph.addComputePass(name);
    const BufferId a = pass.read(small.buffer);
    const BufferId b = pass.read(large.buffer);
    const BufferId sums = pass.write(
        graph.createBuffer(std::string(name) + " strips", std::uint64_t(strips) * elements * 4));
    const BufferId to = pass.write(gradient.block);
    gpu::ConvWeightPush push{.small = small.view(),
                             .large = large.view(),
                             .smallChannels = small.desc.c,
                             .largeChannels = large.desc.c,
                             .kernelHeight = kernel.h,
                             .kernelWidth = kernel.w,
                             .strideHeight = stride.h,
                             .strideWidth = stride.w,
                             .paddingHeight = padding.h,
                             .paddingWidth = padding.w,
                             .pixels = pixels,
                             .stripPixels = stripPixels,
                             .firstStrip = 0};
    const std::uint64_t workPerStrip =
        std::uint64_t(stripPixels) * tilesA * tilesB * columnTile * kLanes * channelVectors;
    const std::uint32_t slice =
        std::uint32_t(std::max<std::uint64_t>(kDispatchWork / workPerStrip, 1));
    for (; push.firstStrip < strips; push.firstStrip += slice)
        pass.dispatch(kernels::conv_backward_weight,
                      {std::min(slice, strips - push.firstStrip) * kLanes, tilesB, tilesA}, push,
                      {a, b, sums}, {channelVectors, columnTile, 2, shuffleFlag(graph)});
    const gpu::ReducePush reduce{elements, strips, gradient.weightOffset};
    pass.dispatch(kernels::strip_sum, {elements, 1, 1}, reduce, {sums, to});
    return to;
}

BufferId addChannelSumPass(RenderGraph& graph, std::string_view name, const TensorId& dY,
                           const LayerWeights& gradient)
{
    const std::uint32_t pixels = dY.desc.n * dY.desc.pixels();
    const std::uint32_t stripPixels = std::max(divideUp(pixels, 512), 16u);
    const std::uint32_t strips = divideUp(pixels, stripPixels);
    checkTripBudget("channel_sum", stripPixels);

    PassBuilder pass = graph.addComputePass(name);
    const BufferId from = pass.read(dY.buffer);
    const BufferId sums = pass.write(
        graph.createBuffer(std::string(name) + " strips", std::uint64_t(strips) * dY.desc.c * 4));
    const BufferId to = pass.write(gradient.block);
    const gpu::ChannelSumPush push{dY.view(), dY.desc.c, pixels, stripPixels};
    pass.dispatch(kernels::channel_sum, {strips, dY.desc.c, 1}, push, {from, sums});
    const gpu::ReducePush reduce{dY.desc.c, strips, gradient.biasOffset};
    pass.dispatch(kernels::strip_sum, {dY.desc.c, 1, 1}, reduce, {sums, to});
    return to;
}

} // namespace strandlight
