#include "compute_nn/conv_channels.hpp"

#include <algorithm>
#include <vector>

#include "compute_nn/conv_row_plan.hpp"
#include "compute_nn/conv_work.hpp"
#include "compute_nn/tile_list.hpp"
#include "engine/base/assert.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

// Whether at least four fifths of what a tile computes exist.
bool fillsTile(std::uint32_t count, std::uint32_t tile)
{
    return count * 5 >= divideUp(count, tile) * tile * 4;
}

std::uint32_t channelsOfTile(std::uint32_t channels)
{
    return channels % 24 == 0 ? 24 : channels > 8 ? 16 : 8;
}

// With stride 1 the transpose is a convolution by the kernel turned about.
ConvPass asConvolution(ConvPass conv)
{
    if (conv.transposed && conv.stride == Extent2{1, 1}) {
        conv.transposed = false;
        conv.padding = {conv.kernel.h - 1 - conv.padding.h, conv.kernel.w - 1 - conv.padding.w};
        conv.turned = true;
    }
    return conv;
}

} // namespace

bool fillsChannelTile(std::uint32_t channels)
{
    return fillsTile(channels, channelsOfTile(channels));
}

std::optional<RowTile> channelTileFor(const RenderGraph& graph, const ConvPass& conv,
                                      const TensorDesc& source, const TensorId& result)
{
    const gpu::TensorView to = result.view();
    const bool strideOne = conv.stride == Extent2{1, 1};
    // A transposed kernel that its padding covers has taps beyond any window; and a strided
    // convolution reads too many rows for a square tile (the row kernel has the same bits).
    if (conv.transposed ? conv.padding.h >= conv.kernel.h || conv.padding.w >= conv.kernel.w
                        : conv.tiles && !strideOne)
        return std::nullopt;
    const RowTile* found = findChannelTile(
        graph.context().cpuForms(), {conv.transposed && !strideOne, conv.kernel, conv.stride});
    if (!found || result.element != Element::Float || source.w % 4 != 0 || to.width % 8 != 0 ||
        to.offset % 8 != 0 || to.imageStride % 8 != 0)
        return std::nullopt;
    RowTile tile = *found;
    tile.channels = channelsOfTile(result.desc.c);
    const std::uint32_t scale = conv.transposed && !strideOne ? conv.stride.h : 1;
    if (!fillsChannelTile(result.desc.c) || !fillsTile(result.desc.h, tile.rows * scale))
        return std::nullopt;
    return tile;
}

TensorId addChannelConvPass(RenderGraph& graph, std::string_view name, const ConvPass& asGiven,
                            const RowTile& found, const TensorId& source,
                            const LayerWeights& weights, const TensorId& result)
{
    const ConvPass conv = asConvolution(asGiven);
    RowTile tile = found;
    if (conv.tiles)
        tile.rows = gpu::kTileSide / (conv.transposed ? conv.stride.h : 1);
    const RowPlan plan(conv, tile, source.desc, result.desc);
    STRANDLIGHT_ASSERT(wholeQuads(source) && wholeQuads(result));
    checkTripBudget("conv_channels", plan.turns + 1);

    PassBuilder pass = graph.addComputePass(name);
    auto [from, packed, into, parameters, to, epilogue, push] =
        bindRows(graph, pass, name, conv, plan, source, weights, result);
    const std::uint32_t flags =
        epilogue.flags | gpu::kConvQuads | (conv.tiles ? gpu::kConvTiles : 0);
    std::vector<std::uint32_t> constants = rowConstants(conv, plan, kConvLanes, flags);
    constants.push_back(tile.rows);
    const KernelBlob& kernel =
        conv.transposed ? kernels::conv_transpose_channels : kernels::conv_channels;

    const TensorId done = result.as(to);
    if (conv.tiles) {
        STRANDLIGHT_ASSERT_EQ(result.desc.n, 1u);
        const BufferId tiles = pass.read(conv.tiles->tiles);
        const std::uint32_t slice = std::uint32_t(std::clamp<std::uint64_t>(
            kDispatchWork / (plan.groupWork * plan.strips), 1, gpu::kTileBlocks));
        for (; push.firstGroup < plan.groups(); push.firstGroup += slice)
            pass.dispatchIndirect(
                kernel, conv.tiles->arguments,
                tileArguments(1, std::min(slice, plan.groups() - push.firstGroup)), push,
                {from, from, packed, parameters, epilogue.saved, epilogue.saved, tiles, into, into,
                 into},
                constants);
        return done;
    }
    const std::uint32_t across = divideUp(result.desc.w, tile.columns * plan.scale.w);
    const std::uint32_t down = result.desc.n * divideUp(result.desc.h, tile.rows * plan.scale.h);
    const std::uint32_t slice = std::uint32_t(std::clamp<std::uint64_t>(
        kDispatchWork / (plan.groupWork * plan.groups() * across * tile.rows), 1, kMaxGroups));
    for (std::uint32_t& first = push.firstStrip; first < down; first += slice)
        pass.dispatch(kernel, {plan.groups() * kConvLanes, across, std::min(slice, down - first)},
                      push,
                      {from, from, packed, parameters, epilogue.saved, epilogue.saved, packed, into,
                       into, into},
                      constants);
    return done;
}

} // namespace strandlight
