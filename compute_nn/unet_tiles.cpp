#include "compute_nn/unet_tiles.hpp"

#include <algorithm>
#include <string>

#include "compute_nn/conv_channels.hpp"
#include "kernels/nn.gen.hpp"
#include "shaders/shared/minimal_filter.h"

namespace strandlight {

namespace {

constexpr std::uint32_t kLanes = 256; // of tile_list.comp's one workgroup

// A layer that the 3x3 convolution of stride 1 to so many channels reads, at full size; at points
// with all that the pixels' groups read.
TileReach aroundKernel(const TileReach& reader, std::uint32_t channels)
{
    const std::uint32_t wider = fillsChannelTile(channels) ? gpu::kMinimalTile : 1;
    return {reader.level, reader.before + wider, reader.after + wider};
}

// A layer below a transposed convolution of stride 2: pixel q makes pixels 2 q - padding onward, so
// [first, end) makes [2 first - padding, 2 end + padding).
TileReach belowDecoder(const TileReach& reader, std::uint32_t padding)
{
    const std::uint32_t wider = padding << reader.level;
    return {reader.level + 1, reader.before + wider, reader.after + wider};
}

// A layer above a 3x3 convolution of stride 2, whose output q reads 2 q - 1 to 2 q + 1: [first,
// end) is read by [first / 2, end / 2 + 1). An odd `first` is rounded down, so it reaches a pixel
// farther back.
TileReach aboveEncoder(const TileReach& reader, bool even)
{
    const std::uint32_t level = reader.level - 1;
    return {level, reader.before + (even ? 0 : 1u << level), reader.after + (1u << reader.level)};
}

TileReach widest(const TileReach& a, const TileReach& b)
{
    return {a.level, std::max(a.before, b.before), std::max(a.after, b.after)};
}

// A skip is read beside `up`, and by the encoder below it. Tiles of 8 stay even through three
// halvings.
TileReach skipReach(const UNetReach& reach, std::uint32_t level, bool tileAligned)
{
    TileReach skip = reach.skip.back();
    for (std::uint32_t l = skip.level; l-- > level;)
        skip = widest(reach.up[l], aboveEncoder(skip, tileAligned && l - level < 3));
    return skip;
}

void addList(RenderGraph& graph, PassBuilder& pass, const TileReach& reach, const TensorDesc& x,
             const TouchedBlocks& touched, const TileRows& rows, const std::string& name,
             TileList& list)
{
    const Extent2 grid = tileGrid({1, 1, x.h >> reach.level, x.w >> reach.level});
    const std::uint32_t tiles = grid.h * grid.w;
    const std::uint32_t blocks = (1u << reach.level) + 3;
    checkTripBudget("tile_list", (std::uint64_t(touched.across) * touched.down) / kLanes +
                                     2ull * ((tiles + kLanes - 1) / kLanes) * blocks * blocks +
                                     kLanes);
    list.tiles = pass.write(graph.createBuffer("tiles " + name, (tiles + kTilePadding) * 4ull));
    list.arguments = pass.write(
        graph.createBuffer("tile arguments " + name, gpu::kTileShares * gpu::kTileBlocks * 12ull));
    const gpu::TileListPush push{.tilesAcross = grid.w,
                                 .tilesDown = grid.h,
                                 .level = reach.level,
                                 .before = reach.before,
                                 .after = reach.after,
                                 .blocksAcross = touched.across,
                                 .blocksDown = touched.down,
                                 .tensorRow = rows.tensorRow,
                                 .firstRow = rows.firstRow,
                                 .endRow = rows.endRow};
    pass.dispatch(kernels::tile_list, {kLanes, 1, 1}, push,
                  {touched.buffer, list.tiles, list.arguments});
}

} // namespace

UNetReach unetReach(const UNetDesc& net)
{
    const std::uint32_t bottom = net.levels();
    UNetReach reach;
    reach.up.resize(bottom);
    reach.skip.resize(bottom + 1);
    // Up: each layer is read by the one above it alone.
    reach.up[0] = aroundKernel(reach.y, net.out);
    for (std::uint32_t l = 1; l < bottom; ++l)
        reach.up[l] = belowDecoder(reach.up[l - 1], net.upKernel / 2 - 1);
    reach.skip[bottom] = belowDecoder(reach.up[bottom - 1], net.upKernel / 2 - 1);
    for (std::uint32_t l = bottom; l-- > 0;)
        reach.skip[l] = skipReach(reach, l, true);
    // What a head reads begins a pixel before the tile: no longer even.
    reach.input = net.head > 0 ? aroundKernel(skipReach(reach, 0, false), net.head) : reach.skip[0];
    return reach;
}

std::vector<LayerTiles> layerTiles(const UNetDesc& net, const TensorDesc& x, const UNetTiles& tiles)
{
    std::vector<LayerTiles> layers;
    const auto add = [&](const std::string& name, std::uint32_t level, const TileList& list,
                         std::uint64_t weights, std::uint32_t workLevel) {
        const auto pixels = [&](std::uint32_t l) { return std::uint64_t(x.h >> l) * (x.w >> l); };
        const Extent2 grid = tileGrid({1, 1, x.h >> level, x.w >> level});
        layers.push_back(
            {name, level, list.arguments, grid.h * grid.w, weights * pixels(workLevel)});
    };
    for (std::uint32_t l = net.head > 0 ? 0 : 1; l <= net.levels(); ++l)
        add("enc" + std::to_string(l), l, tiles.skip[l], net.encoder(l).weightElements(), l);
    for (std::uint32_t l = net.levels(); l-- > 0;) // a transposed one works by input pixel
        add("dec" + std::to_string(l), l, tiles.up[l], net.decoder(l).weightElements(), l + 1);
    add("out", 0, tiles.y, net.last().weightElements(), 0);
    return layers;
}

UNetTiles addUNetTilesPass(RenderGraph& graph, const UNetDesc& net, const TensorDesc& x,
                           const TouchedBlocks& touched, const TileRows& rows)
{
    const UNetReach reach = unetReach(net);
    UNetTiles tiles;
    tiles.up.resize(reach.up.size());
    tiles.skip.resize(reach.skip.size());
    PassBuilder pass = graph.addComputePass("unet tiles");
    pass.read(touched.buffer);
    const auto add = [&](const TileReach& wanted, const std::string& name, TileList& list) {
        addList(graph, pass, wanted, x, touched, rows, name, list);
    };
    add(reach.y, "y", tiles.y);
    add(reach.input, "input", tiles.input);
    for (std::size_t l = 0; l < reach.up.size(); ++l)
        add(reach.up[l], "up " + std::to_string(l), tiles.up[l]);
    for (std::size_t l = net.head > 0 ? 0 : 1; l < reach.skip.size(); ++l)
        add(reach.skip[l], "skip " + std::to_string(l), tiles.skip[l]);
    return tiles;
}

} // namespace strandlight
