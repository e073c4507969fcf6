#include "passes/hair_conv.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "compute_nn/conv_channels.hpp"
#include "compute_nn/conv_row_plan.hpp"
#include "engine/base/error.hpp"
#include "engine/vk/device_limits.hpp"
#include "kernels/hair.gen.hpp"

namespace strandlight {
namespace {

static_assert(sizeof(gpu::HairConvPush) == 88);

// All channels of a layer in one invocation, up to 32: another block of them would fetch the pixels
// again.
RowTile tileFor(const RenderGraph& graph, const ConvPass& conv, bool continued, const TensorDesc& x,
                const TensorId& y)
{
    RowTile tile = y.desc.c > 16 ? RowTile{32, 4, 1} : RowTile{16, 8, 1};
    // Sums at points cannot go on from a result.
    const std::optional<RowTile> ofPlanes = channelTileFor(graph, conv, x, y);
    tile.minimal = ofPlanes && ofPlanes->minimal && !continued;
    return tile;
}

// What a tile of the result reads, in rows of texels of four floats (hair_conv.comp).
std::uint32_t stageTexels(const ConvPass& conv)
{
    const std::uint32_t rows = (gpu::kTileSide - 1) * conv.stride.h + conv.kernel.h;
    return rows * divideUp((gpu::kTileSide - 1) * conv.stride.w + conv.kernel.w, 4);
}

void check(const RenderGraph& graph, const ConvPass& conv, const TensorId& y)
{
    if (conv.transposed || conv.stride.w > 2 || y.desc.n != 1) // windows begin at whole texels
        throw Error("hair filter: the input is fetched for layers of one picture, stride 1 or 2");
    const std::uint32_t wanted = stageTexels(conv) * gpu::kHairPartPlanes * 16;
    const std::uint32_t most = maxSharedBytes(graph.context());
    if (wanted > most)
        throw Error("hair filter: to fetch the network's input takes " + std::to_string(wanted) +
                    " bytes of shared memory, the device has " + std::to_string(most) +
                    " (maxComputeSharedMemorySize); use the planes (--fuse-fetch off)");
}

TensorId addHairConvPass(RenderGraph& graph, std::string_view name, const ConvPass& conv,
                         bool continued, const HairFilterInput& input, const TensorDesc& x,
                         std::uint32_t firstRow, const LayerWeights& weights, const TensorId& y)
{
    check(graph, conv, y);
    const RowTile tile = tileFor(graph, conv, continued, x, y);
    const RowPlan plan(conv, tile, x, y.desc);
    checkTripBudget("hair_conv", plan.turns + 2 * stageTexels(conv));
    const std::uint32_t strips = gpu::kTileSide * gpu::kTileSide / tile.columns; // of a tile

    PassBuilder pass = graph.addComputePass(name);
    const Binding features(pass.sample(input.samples.features), Filter::Nearest);
    const Binding shape(pass.sample(input.samples.shape), Filter::Nearest);
    const ImageId blended = pass.read(input.blended);
    const BufferId parameters = pass.read(weights.block);
    const Binding into = y.binding(pass.write(y.buffer));
    const ConvEpilogue epilogue = bindEpilogue(graph, pass, name, conv, into, y);
    const BufferId packed =
        packWeights(graph, pass, name, conv, plan, weights, parameters, y.desc.c);
    const glm::uvec3 picture = graph.extent(input.blended);
    gpu::HairConvPush push{
        .conv = rowPush(x, y, y.view(), weights, epilogue.slope), // kConvContinue reads y
        .from = {firstRow, picture.x, picture.y, input.depth.offset, input.depth.scale}};
    push.conv.source.height = x.h;
    push.conv.source.width = x.w;
    const std::uint32_t flags = epilogue.flags | (conv.tiles ? gpu::kConvTiles : 0) |
                                (wholeQuads(y) ? gpu::kConvQuads : 0) |
                                (continued ? gpu::kConvContinue : 0);
    const std::vector<std::uint32_t> constants = rowConstants(conv, plan, strips, flags);
    const KernelBlob& kernel =
        y.element == Element::Half ? kernels::hair_conv_half : kernels::hair_conv;
    const TensorId done = y.as(std::get<BufferId>(into.resource));
    if (conv.tiles) {
        const BufferId tiles = pass.read(conv.tiles->tiles);
        pass.dispatchIndirect(kernel, conv.tiles->arguments, tileArguments(1, plan.groups()), push,
                              {features, shape, packed, parameters, into, into, tiles, into, into,
                               blended, epilogue.guard},
                              constants);
        return done;
    }
    const Extent2 grid = tileGrid(y.desc);
    const std::uint32_t slice = std::uint32_t(std::clamp<std::uint64_t>(
        kDispatchWork / (plan.groupWork * plan.groups() * strips), 1, kMaxGroups));
    for (std::uint32_t& first = push.conv.firstStrip; first < grid.h * grid.w; first += slice)
        pass.dispatch(kernel, {plan.groups() * strips, std::min(slice, grid.h * grid.w - first), 1},
                      push,
                      {features, shape, packed, parameters, into, into, packed, into, into, blended,
                       epilogue.guard},
                      constants);
    return done;
}

} // namespace

bool hairFetchPays(const Context& context)
{
    constexpr bool kCpu = false; // lavapipe: 1.6 times the time of the planes (README.md)
    constexpr bool kGpu = false; // not measured
    return context.cpuForms() ? kCpu : kGpu;
}

UNetFetch hairFetch(RenderGraph& graph, const HairFilterInput& input, const TensorDesc& x,
                    std::uint32_t firstRow)
{
    if (!input.samples.features.valid() || !input.samples.shape.valid())
        throw Error("hair: the network's input needs strands drawn with features");
    return {
        x, [&graph, input, x, firstRow](std::string_view name, const ConvPass& conv, bool continued,
                                        const LayerWeights& weights, const TensorId& y) {
            return addHairConvPass(graph, name, conv, continued, input, x, firstRow, weights, y);
        }};
}

} // namespace strandlight
