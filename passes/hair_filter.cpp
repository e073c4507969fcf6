#include "passes/hair_filter.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "compute_nn/unet.hpp"
#include "engine/base/error.hpp"
#include "kernels/hair.gen.hpp"
#include "passes/hair_conv.hpp"

namespace strandlight {
namespace {

static_assert(sizeof(gpu::HairCompositePush) == 36);

// Rows above and below that an output pixel sees, at most: 2^levels for the pixel's own block and
// as much again for the convolutions going down, at three levels and padded to 8.
constexpr std::uint32_t kMarginRows = 16;

struct Band
{
    TileRows rows;
    std::uint32_t tensorEnd;
};

Band bandAt(std::uint32_t firstRow, std::uint32_t rows, std::uint32_t paddedHeight)
{
    const std::uint32_t end = std::min(firstRow + rows, paddedHeight);
    return {{firstRow - std::min(firstRow, kMarginRows), firstRow, end},
            std::min(end + kMarginRows, paddedHeight)};
}

std::uint32_t chooseBandRows(const RenderGraph& graph, const UNetDesc& net,
                             const TensorDesc& picture, const HairFilterSettings& settings,
                             bool fused)
{
    if (settings.bandRows > 0)
        return (settings.bandRows + 7) / 8 * 8;
    // Planes of a full row: level 0, or what layers that fetch the input write, as texels too.
    const std::uint32_t planes =
        fused && net.head == 0 ? std::max({net.upChannels(0), net.out, (net.channels(1) + 3) / 4})
                               : net.channels(0);
    const std::uint64_t bytes =
        fused ? graph.context().maxTensorBindingBytes() : graph.context().maxStorageBufferBytes();
    const std::uint64_t rowBytes = std::uint64_t(picture.w) * planes * sizeof(float);
    const auto most = std::uint32_t(bytes / rowBytes / 8 * 8);
    if (most < 3 * kMarginRows)
        throw Error("hair filter: a picture of " + std::to_string(picture.w) +
                    " pixels a row is too wide for the device");
    if (most >= picture.h)
        return picture.h;
    const std::uint32_t bands = (picture.h + most - 2 * kMarginRows - 1) / (most - 2 * kMarginRows);
    return (picture.h + 8 * bands - 1) / (8 * bands) * 8;
}

TouchedBlocks addTouchedPass(RenderGraph& graph, ImageId blended)
{
    const glm::uvec3 size = graph.extent(blended);
    TouchedBlocks touched{{}, (size.x + 7) / 8, (size.y + 7) / 8};
    PassBuilder pass = graph.addComputePass("hair touched");
    pass.read(blended);
    touched.buffer = pass.write(graph.createBuffer(
        "touched blocks", std::uint64_t(touched.across) * touched.down * sizeof(std::uint32_t)));
    const gpu::HairTouchedPush push{size.x, size.y, touched.across, touched.down};
    pass.dispatch(kernels::hair_touched, {touched.across, touched.down, 1}, push,
                  {blended, touched.buffer});
    return touched;
}

// The network over rows [firstRow, firstRow + x.h) of the picture.
TensorId addNetwork(RenderGraph& graph, const UNetDesc& net, const ParameterIds& parameters,
                    const HairFilterInput& input, const TensorDesc& x, std::uint32_t firstRow,
                    const UNetTiles* tiles, HalfGuard* halves, bool fused)
{
    if (fused)
        return unetForward(graph, net, parameters, hairFetch(graph, input, x, firstRow), tiles,
                           halves);
    const TensorId to = createUNetInput(graph, net, x, halves ? Element::Half : Element::Float);
    const TensorId planes = addHairInputPass(graph, input.samples, input.blended, input.depth, to,
                                             firstRow, tiles ? &tiles->input : nullptr);
    return unetForward(graph, net, parameters, planes, tiles, halves).y;
}

void addCompositePass(RenderGraph& graph, const HairFilterInput& input, const TensorId& y,
                      const TileRows& rows, const TileList* tiles, HairComposite& over)
{
    const glm::uvec3 size = graph.extent(input.blended);
    PassBuilder pass = graph.addComputePass("hair composite");
    const BufferId answer = pass.read(y.buffer);
    const BufferId list = tiles ? pass.read(tiles->tiles) : answer;
    const ImageId blended = pass.read(input.blended);
    over.filtered = pass.write(over.filtered);
    over.radiance = pass.write(over.radiance);
    const gpu::HairCompositePush push{
        y.view(), size.x, size.y, rows.firstRow, std::min(rows.endRow, size.y), rows.tensorRow};
    if (tiles)
        pass.dispatchIndirect(kernels::hair_composite, tiles->arguments, tileArguments(1, 1), push,
                              {answer, blended, over.filtered, over.radiance, list}, {1});
    else
        pass.dispatch(kernels::hair_composite, {y.desc.w, y.desc.h, 1}, push,
                      {answer, blended, over.filtered, over.radiance, list}, {0});
}

} // namespace

HairComposite addHairFilterPasses(RenderGraph& graph, const UNetDesc& net,
                                  const ParameterIds& parameters, const HairFilterInput& input,
                                  const HairComposite& over, const HairFilterSettings& settings)
{
    if (net.in != gpu::kHairInputPlanes || net.out != gpu::kHairOutputs || net.levels() > 3)
        throw Error("hair filter: a network of " + std::to_string(net.in) + " planes to " +
                    std::to_string(net.out) + " with " + std::to_string(net.levels()) +
                    " levels, it must be " + std::to_string(gpu::kHairInputPlanes) + " to " +
                    std::to_string(gpu::kHairOutputs) + " with at most 3");
    const glm::uvec3 size = graph.extent(input.blended);
    const TensorDesc picture = hairInputDesc(size.x, size.y);
    const bool fused = settings.fuseFetch.value_or(hairFetchPays(graph.context()));
    const std::uint32_t rows = chooseBandRows(graph, net, picture, settings, fused);
    HairComposite result = over;
    TouchedBlocks touched;
    if (settings.skipTiles)
        touched = addTouchedPass(graph, input.blended);
    for (std::uint32_t first = 0; first < picture.h; first += rows) {
        const Band band = bandAt(first, rows, picture.h);
        TensorDesc desc = picture;
        desc.h = band.tensorEnd - band.rows.tensorRow;
        std::optional<UNetTiles> tiles;
        if (settings.skipTiles) {
            tiles = addUNetTilesPass(graph, net, desc, touched, band.rows);
            const std::vector<LayerTiles> layers = layerTiles(net, desc, *tiles);
            result.tiles.insert(result.tiles.end(), layers.begin(), layers.end());
        }
        const TensorId y = addNetwork(graph, net, parameters, input, desc, band.rows.tensorRow,
                                      tiles ? &*tiles : nullptr, settings.halves, fused);
        addCompositePass(graph, input, y, band.rows, tiles ? &tiles->y : nullptr, result);
    }
    return result;
}

} // namespace strandlight
