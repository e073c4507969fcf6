#include "compute_nn/conv_rows.hpp"

#include <algorithm>
#include <vector>

#include "compute_nn/conv_work.hpp"
#include "compute_nn/tile_list.hpp"
#include "engine/base/assert.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

constexpr std::uint32_t kGroup = 64; // strips of a workgroup

} // namespace

TensorId addRowConvPass(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                        const RowTile& tile, const TensorId& source, const LayerWeights& weights,
                        const TensorId& result)
{
    const Extent2 scale = conv.transposed ? conv.stride : Extent2{1, 1};
    const std::uint32_t turn = unroll(source.desc.c, tile.turn);
    checkTripBudget("conv_rows", source.desc.c / turn + 1);
    const std::uint32_t blocks = divideUp(result.desc.c, tile.channels);
    const std::uint32_t channels = divideUp(result.desc.c, blocks);
    const std::uint32_t strips = result.desc.n * divideUp(result.desc.h, scale.h) *
                                 divideUp(divideUp(result.desc.w, scale.w), tile.columns);
    const std::uint64_t blockWork = std::uint64_t(conv.kernel.h) * conv.kernel.w * source.desc.c *
                                    channels * tile.columns; // of one strip

    PassBuilder pass = graph.addComputePass(name);
    const Binding from = source.binding(pass.read(source.buffer));
    const BufferId parameters = pass.read(weights.block);
    const BufferId to = pass.write(result.buffer);
    const ConvEpilogue epilogue = bindEpilogue(graph, pass, conv, from);
    gpu::ConvRowsPush push{.source = source.view(),
                           .result = result.view(),
                           .savedOffset = epilogue.savedView.offset,
                           .savedImageStride = epilogue.savedView.imageStride,
                           .inChannels = source.desc.c,
                           .outChannels = result.desc.c,
                           .weightOffset = weights.weightOffset,
                           .weightStrideOut = conv.weightStrideOut,
                           .weightStrideIn = conv.weightStrideIn,
                           .biasOffset = weights.biasOffset,
                           .firstChannel = 0,
                           .firstStrip = 0,
                           .endStrip = strips,
                           .slope = epilogue.slope};
    const std::vector<std::uint32_t> constants = {kGroup,
                                                  channels,
                                                  tile.columns,
                                                  turn,
                                                  conv.kernel.h,
                                                  conv.kernel.w,
                                                  conv.stride.h,
                                                  conv.stride.w,
                                                  conv.padding.h,
                                                  conv.padding.w,
                                                  epilogue.flags |
                                                      (conv.tiles ? gpu::kConvTiles : 0)};
    const KernelBlob& kernel = conv.transposed ? kernels::conv_transpose_rows : kernels::conv_rows;

    if (conv.tiles) { // cut by blocks of channels, as if all tiles were active
        STRANDLIGHT_ASSERT_EQ(result.desc.n, 1u);
        const BufferId tiles = pass.read(conv.tiles->tiles);
        const std::uint32_t stripsPerTile =
            (gpu::kTileSide / (scale.w * tile.columns)) * (gpu::kTileSide / scale.h);
        const std::uint32_t slice = std::uint32_t(
            std::clamp<std::uint64_t>(kDispatchWork / (blockWork * strips), 1, gpu::kTileBlocks));
        for (std::uint32_t first = 0; first < blocks; first += slice) {
            push.firstChannel = first * channels;
            pass.dispatchIndirect(
                kernel, conv.tiles->arguments,
                tileArguments(kGroup / stripsPerTile, std::min(slice, blocks - first)), push,
                {from, parameters, epilogue.saved, tiles, result.binding(to)}, constants);
        }
        return result.as(to);
    }
    const std::uint32_t slice = std::uint32_t(std::clamp<std::uint64_t>(
                                    kDispatchWork / (blockWork * blocks * kGroup), 1, kMaxGroups)) *
                                kGroup;
    for (std::uint32_t first = 0; first < strips; first += slice) {
        push.firstStrip = first;
        push.endStrip = std::min(strips, first + slice);
        pass.dispatch(kernel, {push.endStrip - first, blocks, 1}, push,
                      {from, parameters, epilogue.saved, from, result.binding(to)}, constants);
    }
    return result.as(to);
}

} // namespace strandlight
