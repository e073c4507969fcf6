#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "compute_nn/conv_passes.hpp"
#include "compute_nn/conv_weight_forms.hpp"
#include "compute_nn/conv_work.hpp"
#include "compute_nn/tensor_parts.hpp"
#include "engine/base/assert.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

// Strips of `count` floats each, as a pass writes them and then adds them up in their order.
struct Strips
{
    BufferId buffer;
    std::uint32_t count, stride, strips;
};

Strips createStrips(RenderGraph& graph, PassBuilder& pass, std::string_view name,
                    std::uint32_t count, std::uint32_t strips)
{
    const std::uint32_t stride = divideUp(count, 4) * 4; // whole quads
    const BufferId buffer = pass.write(
        graph.createBuffer(std::string(name) + " strips", std::uint64_t(strips) * stride * 4));
    return {buffer, count, stride, strips};
}

// Strips of `count` floats that one binding holds, at least 1.
std::uint32_t bindableStrips(const RenderGraph& graph, std::uint32_t count)
{
    const std::uint64_t bytes = std::uint64_t(divideUp(count, 4)) * 16;
    return std::uint32_t(
        std::clamp<std::uint64_t>(graph.context().maxTensorBindingBytes() / bytes, 1, kMaxGroups));
}

// Many strips are added in two stages, so that as many threads take part.
constexpr std::uint32_t kStripsOfOneStage = 48;

void addStrips(RenderGraph& graph, PassBuilder& pass, std::string_view name, Strips from,
               BufferId to, std::uint32_t resultOffset)
{
    gpu::ReducePush push{from.count, from.stride, from.strips, from.strips, resultOffset, 1};
    if (from.strips > kStripsOfOneStage) {
        const std::uint32_t groups = std::uint32_t(std::ceil(std::sqrt(double(from.strips))));
        push.groupStrips = divideUp(from.strips, groups);
        push.resultOffset = 0;
        push.accumulate = 0;
        const std::string sums = std::string(name) + " sums";
        const Strips partial =
            createStrips(graph, pass, sums, from.count, divideUp(from.strips, push.groupStrips));
        checkTripBudget("strip_sum", push.groupStrips);
        pass.dispatch(kernels::strip_sum, {from.stride / 4, partial.strips, 1}, push,
                      {from.buffer, partial.buffer});
        from = partial;
        push = {from.count, from.stride, from.strips, from.strips, resultOffset, 1};
    }
    checkTripBudget("strip_sum", push.groupStrips);
    pass.dispatch(kernels::strip_sum, {from.stride / 4, 1, 1}, push, {from.buffer, to});
}

BufferId addBoundCorrelationPass(RenderGraph& graph, std::string_view name,
                                 const Correlation& correlation, const LayerWeights& gradient)
{
    const TensorId& small = correlation.small;
    const TensorId& large = correlation.large;
    STRANDLIGHT_ASSERT_EQ(small.desc.n, large.desc.n);
    STRANDLIGHT_ASSERT(small.element == Element::Float && large.element == Element::Float);
    const std::uint32_t taps = correlation.kernel.h * correlation.kernel.w;
    const std::uint32_t elements = small.desc.c * large.desc.c * taps;
    WeightForm form = weightForm(graph.context().cpuForms(), shuffleFlag(graph), correlation);
    const std::uint32_t longer = divideUp(form.strips, bindableStrips(graph, elements));
    form.stripLength *= longer;
    form.stripWork *= longer;
    form.strips = divideUp(form.strips, longer);
    checkTripBudget(form.blob->name, std::uint64_t(form.stripLength) * form.unitTurns);

    PassBuilder pass = graph.addComputePass(name);
    const Binding a = small.binding(pass.read(small.buffer));
    const Binding b = large.binding(pass.read(large.buffer));
    const Strips strips = createStrips(graph, pass, name, elements, form.strips);
    const BufferId to = pass.write(gradient.block);
    gpu::ConvWeightPush push{.small = small.view(),
                             .large = large.view(),
                             .smallChannels = small.desc.c,
                             .largeChannels = large.desc.c,
                             .kernelHeight = correlation.kernel.h,
                             .kernelWidth = correlation.kernel.w,
                             .strideHeight = correlation.stride.h,
                             .strideWidth = correlation.stride.w,
                             .paddingHeight = correlation.padding.h,
                             .paddingWidth = correlation.padding.w,
                             .pixels = small.desc.n * small.desc.pixels(),
                             .stripLength = form.stripLength,
                             .firstStrip = 0,
                             .stripStride = strips.stride,
                             .strideSmall = large.desc.c * taps,
                             .strideLarge = taps,
                             .turned = form.turned};
    if (form.turned) {
        push.pixels = large.desc.n * large.desc.pixels();
        std::swap(push.small, push.large);
        std::swap(push.smallChannels, push.largeChannels);
        std::swap(push.strideSmall, push.strideLarge);
    }
    const std::uint32_t slice =
        std::uint32_t(std::clamp<std::uint64_t>(kDispatchWork / form.stripWork, 1, kMaxGroups));
    for (; push.firstStrip < form.strips; push.firstStrip += slice)
        pass.dispatch(*form.blob,
                      {form.tilesB * form.groupSize, form.tilesA,
                       std::min(slice, form.strips - push.firstStrip)},
                      push, {form.turned ? b : a, form.turned ? a : b, strips.buffer},
                      form.constants);
    addStrips(graph, pass, name, strips, to, gradient.weightOffset);
    return to;
}

BufferId addBoundChannelSumPass(RenderGraph& graph, std::string_view name, const TensorId& dY,
                                const LayerWeights& gradient)
{
    const gpu::TensorView view = dY.view();
    const bool quads =
        dY.desc.pixels() % 4 == 0 && view.offset % 4 == 0 && view.imageStride % 4 == 0;
    const std::uint32_t texels = dY.desc.n * dY.desc.pixels() / (quads ? 4 : 1);
    // Whole workgroups, enough to fill a GPU with a few channels.
    const std::uint32_t most = std::clamp(bindableStrips(graph, dY.desc.c) / 32 * 32, 32u, 2048u);
    const std::uint32_t invocations =
        std::min(divideUp(std::max(divideUp(texels, 64), 1u), 32) * 32, most);
    checkTripBudget("channel_sum", divideUp(texels, invocations));

    PassBuilder pass = graph.addComputePass(name);
    const Binding from = dY.binding(pass.read(dY.buffer));
    const Strips strips = createStrips(graph, pass, name, dY.desc.c, invocations);
    const BufferId to = pass.write(gradient.block);
    const gpu::ChannelSumPush push{view, dY.desc.n, invocations, strips.stride};
    pass.dispatch(kernels::channel_sum, {invocations, dY.desc.c, 1}, push,
                  {from, from, strips.buffer}, {quads ? 4u : 1u});
    addStrips(graph, pass, name, strips, to, gradient.biasOffset);
    return to;
}

} // namespace

// Parts add to the same gradient: images, and of one image ranges of channels. The small tensor's
// are rows of the gradient; a range of the large one's is part of a row, so rows come singly then.
BufferId addCorrelationPass(RenderGraph& graph, std::string_view name,
                            const Correlation& correlation, const LayerWeights& gradient)
{
    const TensorId& small = correlation.small;
    const TensorId& large = correlation.large;
    LayerWeights to = gradient;
    if (fitBindings(graph, {small, large}))
        return addBoundCorrelationPass(graph, name, correlation, to);
    const std::uint32_t images = imagesPerPart(graph, {small, large});
    const std::uint32_t columns = images == 1 ? channelsPerPart(graph, name, large) : large.desc.c;
    const std::uint32_t rows = columns < large.desc.c ? 1
                               : images == 1          ? channelsPerPart(graph, name, small)
                                                      : small.desc.c;
    const std::uint32_t taps = correlation.kernel.h * correlation.kernel.w;
    for (std::uint32_t n = 0; n < small.desc.n; n += images)
        for (std::uint32_t a = 0; a < small.desc.c; a += rows)
            for (std::uint32_t b = 0; b < large.desc.c; b += columns) {
                const std::uint32_t count = std::min(images, small.desc.n - n);
                to.weightOffset = gradient.weightOffset + (a * large.desc.c + b) * taps;
                Correlation part = correlation;
                part.small = boundPart(small, n, count, a, std::min(rows, small.desc.c - a));
                part.large = boundPart(large, n, count, b, std::min(columns, large.desc.c - b));
                to.block = addBoundCorrelationPass(graph, name, part, to);
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
