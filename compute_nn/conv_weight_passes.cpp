#include <algorithm>
#include <string>

#include "compute_nn/conv_passes.hpp"
#include "compute_nn/conv_work.hpp"
#include "compute_nn/tensor_parts.hpp"
#include "engine/base/assert.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

// A x 8 channels and B columns of conv_backward_weight.comp.
constexpr std::uint32_t kColumnTile = 32;

BufferId addBoundCorrelationPass(RenderGraph& graph, std::string_view name, Extent2 kernel,
                                 Extent2 stride, Extent2 padding, const TensorId& small,
                                 const TensorId& large, const LayerWeights& gradient)
{
    STRANDLIGHT_ASSERT_EQ(small.desc.n, large.desc.n);
    const std::uint32_t columns = large.desc.c * kernel.h * kernel.w;
    const std::uint32_t elements = small.desc.c * columns;
    const std::uint32_t pixels = small.desc.n * small.desc.pixels();
    const std::uint32_t channelVectors = small.desc.c > kConvLanes ? 2 : 1;
    const std::uint32_t columnTile = columns > 8 ? kColumnTile : 8;
    const std::uint32_t tilesA = divideUp(small.desc.c, kConvLanes * channelVectors);
    const std::uint32_t tilesB = divideUp(columns, columnTile);

    // Enough strips to fill the threads, short enough for the trip budget, few enough to keep the
    // strips small.
    const std::uint64_t bindable = graph.context().maxTensorBindingBytes() / (elements * 4ull);
    const std::uint32_t wanted = std::uint32_t(
        std::clamp<std::uint64_t>(std::max(divideUp(256, tilesA * tilesB), divideUp(pixels, 16384)),
                                  1, std::max<std::uint64_t>(bindable, 1)));
    const std::uint32_t stripPixels = std::max(divideUp(pixels, wanted), 16u);
    const std::uint32_t strips = divideUp(pixels, stripPixels);
    checkTripBudget("conv_backward_weight", stripPixels / 2 + 1);
    checkTripBudget("strip_sum", strips);

    PassBuilder pass = graph.addComputePass(name);
    const Binding a = small.binding(pass.read(small.buffer));
    const Binding b = large.binding(pass.read(large.buffer));
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
        std::uint64_t(stripPixels) * tilesA * tilesB * columnTile * kConvLanes * channelVectors;
    const std::uint32_t slice =
        std::uint32_t(std::max<std::uint64_t>(kDispatchWork / workPerStrip, 1));
    for (; push.firstStrip < strips; push.firstStrip += slice)
        pass.dispatch(kernels::conv_backward_weight,
                      {std::min(slice, strips - push.firstStrip) * kConvLanes, tilesB, tilesA},
                      push, {a, b, sums}, {channelVectors, columnTile, 2, shuffleFlag(graph)});
    const gpu::ReducePush reduce{elements, strips, gradient.weightOffset};
    pass.dispatch(kernels::strip_sum, {elements, 1, 1}, reduce, {sums, to});
    return to;
}

BufferId addBoundChannelSumPass(RenderGraph& graph, std::string_view name, const TensorId& dY,
                                const LayerWeights& gradient)
{
    const std::uint32_t pixels = dY.desc.n * dY.desc.pixels();
    const std::uint32_t stripPixels = std::max(divideUp(pixels, 512), 16u);
    const std::uint32_t strips = divideUp(pixels, stripPixels);
    checkTripBudget("channel_sum", stripPixels);

    PassBuilder pass = graph.addComputePass(name);
    const Binding from = dY.binding(pass.read(dY.buffer));
    const BufferId sums = pass.write(
        graph.createBuffer(std::string(name) + " strips", std::uint64_t(strips) * dY.desc.c * 4));
    const BufferId to = pass.write(gradient.block);
    const gpu::ChannelSumPush push{dY.view(), dY.desc.c, pixels, stripPixels};
    pass.dispatch(kernels::channel_sum, {strips, dY.desc.c, 1}, push, {from, sums});
    const gpu::ReducePush reduce{dY.desc.c, strips, gradient.biasOffset};
    pass.dispatch(kernels::strip_sum, {dY.desc.c, 1, 1}, reduce, {sums, to});
    return to;
}

} // namespace

// Parts add to the same gradient: images, and of one image ranges of channels. The small tensor's
// are rows of the gradient; a range of the large one's is part of a row, so rows come singly then.
BufferId addCorrelationPass(RenderGraph& graph, std::string_view name, Extent2 kernel,
                            Extent2 stride, Extent2 padding, const TensorId& small,
                            const TensorId& large, const LayerWeights& gradient)
{
    LayerWeights to = gradient;
    if (fitBindings(graph, {small, large}))
        return addBoundCorrelationPass(graph, name, kernel, stride, padding, small, large, to);
    const std::uint32_t images = imagesPerPart(graph, {small, large});
    const std::uint32_t columns = images == 1 ? channelsPerPart(graph, name, large) : large.desc.c;
    const std::uint32_t rows = columns < large.desc.c ? 1
                               : images == 1          ? channelsPerPart(graph, name, small)
                                                      : small.desc.c;
    const std::uint32_t taps = kernel.h * kernel.w;
    for (std::uint32_t n = 0; n < small.desc.n; n += images)
        for (std::uint32_t a = 0; a < small.desc.c; a += rows)
            for (std::uint32_t b = 0; b < large.desc.c; b += columns) {
                const std::uint32_t count = std::min(images, small.desc.n - n);
                to.weightOffset = gradient.weightOffset + (a * large.desc.c + b) * taps;
                to.block = addBoundCorrelationPass(
                    graph, name, kernel, stride, padding,
                    boundPart(small, n, count, a, std::min(rows, small.desc.c - a)),
                    boundPart(large, n, count, b, std::min(columns, large.desc.c - b)), to);
            }
    return to.block;
}

BufferId addChannelSumPass(RenderGraph& graph, std::string_view name, const TensorId& dY,
                           const LayerWeights& gradient)
{
    LayerWeights to = gradient;
    if (fitBindings(graph, {dY}))
        return addBoundChannelSumPass(graph, name, dY, to);
    const std::uint32_t images = imagesPerPart(graph, {dY});
    const std::uint32_t channels = images == 1 ? channelsPerPart(graph, name, dY) : dY.desc.c;
    for (std::uint32_t n = 0; n < dY.desc.n; n += images)
        for (std::uint32_t c = 0; c < dY.desc.c; c += channels) {
            to.biasOffset = gradient.biasOffset + c;
            to.block = addBoundChannelSumPass(graph, name,
                                              boundPart(dY, n, std::min(images, dY.desc.n - n), c,
                                                        std::min(channels, dY.desc.c - c)),
                                              to);
        }
    return to.block;
}

} // namespace strandlight
