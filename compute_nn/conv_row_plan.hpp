// How the sliding-window kernels cut a layer, and their weights in the order in which they deal
// them out; for the files of these kernels, here and in passes/hair_conv.cpp.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "compute_nn/conv_passes.hpp"
#include "compute_nn/conv_tiles.hpp"
#include "compute_nn/conv_work.hpp"
#include "shaders/shared/minimal_filter.h"

namespace strandlight {

// How a layer is cut: into groups, that is blocks of output channels x row phases, and strips.
struct RowPlan
{
    Extent2 scale; // pixels of the result per row and column of the grid
    std::uint32_t turn, turns, blocks, channels, phases;
    std::uint32_t lanes;   // channels of a block are dealt to so many
    bool minimal;          // rows are taken by minimal_filter.h
    std::uint32_t rowTaps; // of a kernel row, or its points
    std::uint32_t columns, taps, strips;
    std::uint64_t groupWork; // multiply-adds of one strip

    RowPlan(const ConvPass& conv, const RowTile& tile, const TensorDesc& source,
            const TensorDesc& result)
        : scale(conv.transposed ? conv.stride : Extent2{1, 1}), turn(unroll(source.c, tile.turn)),
          turns(source.c / turn), blocks(divideUp(result.c, tile.channels)),
          channels(divideUp(divideUp(result.c, blocks), tile.lanes) * tile.lanes),
          phases(tile.splitRows ? scale.h : 1), lanes(tile.lanes), minimal(tile.minimal),
          rowTaps(minimal ? gpu::kMinimalPoints : conv.kernel.w), columns(tile.columns),
          taps(conv.kernel.h * rowTaps / phases),
          strips(result.n * divideUp(result.h, scale.h) *
                 divideUp(divideUp(result.w, scale.w), tile.columns)),
          groupWork(std::uint64_t(taps) * source.c * channels * tile.columns /
                    (minimal ? gpu::kMinimalTile : 1))
    {
    }
    std::uint32_t groups() const { return blocks * phases; }
    std::uint32_t turnTexels() const { return divideUp(turn * channels / lanes * taps, 4) * lanes; }
};

// What conv_rows.glsl is told: push constants for all groups and strips from the first on, without
// the source's view and the last strip; `saved`: of what the epilogue reads.
gpu::ConvRowsPush rowPush(const TensorDesc& source, const TensorId& result,
                          const gpu::TensorView& saved, const LayerWeights& weights, float slope);
// Its specialization constants, in their order; `group`: invocations of a workgroup.
std::vector<std::uint32_t> rowConstants(const ConvPass& conv, const RowPlan& plan,
                                        std::uint32_t group, std::uint32_t flags);

// Packs the weights in a dispatch of the same pass.
BufferId packWeights(RenderGraph& graph, PassBuilder& pass, std::string_view name,
                     const ConvPass& conv, const RowPlan& plan, const LayerWeights& weights,
                     BufferId parameters, std::uint32_t outChannels);

// What every such pass over tensors binds and pushes; weights are packed on the way.
struct RowBindings
{
    Binding source, packed, result;
    BufferId parameters, resultBuffer;
    ConvEpilogue epilogue;
    gpu::ConvRowsPush push; // without the last strip
};
RowBindings bindRows(RenderGraph& graph, PassBuilder& pass, std::string_view name,
                     const ConvPass& conv, const RowPlan& plan, const TensorId& source,
                     const LayerWeights& weights, const TensorId& result);

} // namespace strandlight
