#include "compute_nn/conv_rows.hpp"

#include <algorithm>
#include <vector>

#include "compute_nn/conv_row_plan.hpp"
#include "compute_nn/conv_work.hpp"
#include "compute_nn/tile_list.hpp"
#include "engine/base/assert.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

constexpr std::uint32_t kGroup = 64; // strips of a workgroup

// Every load and store of four neighbours is one texel of each tensor.
bool hasQuads(const ConvPass& conv, const RowTile& tile, const TensorId& source,
              const TensorId& result)
{
    const std::uint32_t loaded = tile.columns * (conv.transposed ? 1 : conv.stride.w);
    const std::uint32_t stored = tile.columns * (conv.transposed ? conv.stride.w : 1);
    return loaded % 4 == 0 && stored % 4 == 0 && wholeQuads(source) && wholeQuads(result) &&
           (!conv.backward.activated || wholeQuads(*conv.backward.activated));
}

// Every store of eight neighbours is one of the result's aligned octets; for devices whose forms
// are a CPU's (conv_rows.glsl).
bool hasOctets(const RenderGraph& graph, const ConvPass& conv, const RowTile& tile,
               const TensorId& source, const TensorId& result)
{
    const std::uint32_t stored = tile.columns * (conv.transposed ? conv.stride.w : 1);
    const gpu::TensorView view = result.view();
    return graph.context().cpuForms() && source.element == Element::Float &&
           result.element == Element::Float && stored % 8 == 0 && view.offset % 8 == 0 &&
           view.imageStride % 8 == 0 && view.width % 8 == 0;
}

// The kernel for these tensors' elements; `octets`: stored by eights.
const KernelBlob& kernelFor(const ConvPass& conv, const TensorId& source, const TensorId& result,
                            bool octets)
{
    if (octets)
        return conv.transposed ? kernels::conv_transpose_rows_wide : kernels::conv_rows_wide;
    return conv.transposed ? variantFor(source, result, kernels::conv_transpose_rows,
                                        kernels::conv_transpose_rows_half,
                                        kernels::conv_transpose_rows_from_half)
                           : variantFor(source, result, kernels::conv_rows, kernels::conv_rows_half,
                                        kernels::conv_rows_from_half);
}

} // namespace

TensorId addRowConvPass(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                        const RowTile& tile, const TensorId& source, const LayerWeights& weights,
                        const TensorId& result)
{
    const RowPlan plan(conv, tile, source.desc, result.desc);
    checkTripBudget("conv_rows", plan.turns + 1);

    PassBuilder pass = graph.addComputePass(name);
    auto [from, packed, into, parameters, to, epilogue, push] =
        bindRows(graph, pass, name, conv, plan, source, weights, result);
    push.endStrip = plan.strips;
    const bool quads = hasQuads(conv, tile, source, result);
    const std::uint32_t flags =
        epilogue.flags | (conv.tiles ? gpu::kConvTiles : 0) | (quads ? gpu::kConvQuads : 0);
    const std::vector<std::uint32_t> constants = rowConstants(conv, plan, kGroup, flags);
    const bool octets = quads && hasOctets(graph, conv, tile, source, result);
    const KernelBlob& kernel = kernelFor(conv, source, result, octets);
    // Without quads nothing reads these two, and the tensors may not be whole texels.
    const Binding fromQuads = quads ? from : packed;
    const Binding savedQuads = quads ? epilogue.saved : packed;
    const Binding last = octets ? into : epilogue.guard; // heldQuads, or the guard

    if (conv.tiles) { // cut by groups, as if all tiles were active
        STRANDLIGHT_ASSERT_EQ(result.desc.n, 1u);
        const BufferId tiles = pass.read(conv.tiles->tiles);
        const std::uint32_t stripsPerTile =
            (gpu::kTileSide / (plan.scale.w * tile.columns)) * (gpu::kTileSide / plan.scale.h);
        const std::uint32_t slice = std::uint32_t(std::clamp<std::uint64_t>(
            kDispatchWork / (plan.groupWork * plan.strips), 1, gpu::kTileBlocks));
        for (; push.firstGroup < plan.groups(); push.firstGroup += slice)
            pass.dispatchIndirect(kernel, conv.tiles->arguments,
                                  tileArguments(kGroup / stripsPerTile,
                                                std::min(slice, plan.groups() - push.firstGroup)),
                                  push,
                                  {from, fromQuads, packed, parameters, epilogue.saved, savedQuads,
                                   tiles, into, into, last},
                                  constants);
        return result.as(to);
    }
    const std::uint32_t slice =
        std::uint32_t(std::clamp<std::uint64_t>(
            kDispatchWork / (plan.groupWork * plan.groups() * kGroup), 1, kMaxGroups)) *
        kGroup;
    for (std::uint32_t first = 0; first < plan.strips; first += slice) {
        push.firstStrip = first;
        push.endStrip = std::min(plan.strips, first + slice);
        pass.dispatch(kernel, {plan.groups() * kGroup, divideUp(push.endStrip - first, kGroup), 1},
                      push,
                      {from, fromQuads, packed, parameters, epilogue.saved, savedQuads, packed,
                       into, into, last},
                      constants);
    }
    return result.as(to);
}

} // namespace strandlight
