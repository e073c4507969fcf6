// Layers over a list of active tiles: those have the bits of the whole, the others keep what they
// held.
#include <doctest/doctest.h>

#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"
#include "engine/base/error.hpp"
#include "tests/nn/compare.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

constexpr float kUntouched = -77.0f;

// One byte per tile of y, row by row.
std::vector<std::uint8_t> randomMask(const TensorDesc& y, float share, std::uint32_t seed)
{
    const Extent2 grid = tileGrid(y);
    const std::vector<float> u = randomValues<float>(grid.h * grid.w, seed, 0.0f, 1.0f);
    std::vector<std::uint8_t> mask;
    for (float value : u)
        mask.push_back(value < share);
    return mask;
}

TileList upload(RenderGraph& graph, const TensorDesc& y, const std::vector<std::uint8_t>& mask)
{
    const std::uint32_t width = tileGrid(y).w;
    std::vector<std::uint32_t> tiles, arguments;
    for (std::uint32_t i = 0; i < mask.size(); ++i)
        if (mask[i])
            tiles.push_back(i % width | i / width << 16);
    for (std::uint32_t share = 1; share <= kTilePadding; share *= 2)
        for (std::uint32_t b = 1; b <= gpu::kTileBlocks; ++b)
            arguments.insert(arguments.end(),
                             {std::uint32_t(tiles.size() + share - 1) / share, b, 1});
    tiles.resize(mask.size() + kTilePadding, ~0u);
    return {graph.uploadBuffer("tiles", std::span<const std::uint32_t>(tiles)),
            graph.uploadBuffer("arguments", std::span<const std::uint32_t>(arguments))};
}

// y over the tiles of `mask`, or all of it without one, on top of kUntouched.
template <class Desc, class Forward>
std::vector<float> run(Forward forward, const Desc& desc, const TensorDesc& xDesc,
                       const std::vector<std::uint8_t>* mask)
{
    RenderGraph graph(context());
    const TensorDesc yDesc = desc.output(xDesc);
    const std::uint32_t count = std::uint32_t(desc.weightElements());
    const std::vector<float> block = randomValues<float>(count + desc.out, 5);
    const std::vector<float> before(yDesc.elements(), kUntouched);
    const LayerWeights weights{graph.uploadBuffer("w", std::span(block)), 0, count, true};
    const TensorId x = uploadTensor(graph, "x", xDesc, randomValues<float>(xDesc.elements(), 6));
    TensorId y = uploadTensor(graph, "y", yDesc, before);
    if (mask) {
        const TileList tiles = upload(graph, yDesc, *mask);
        y = forward(graph, "tiles", desc, x, weights, y, Activation::leakyRelu(0.1f), &tiles,
                    nullptr);
    } else {
        y = forward(graph, "whole", desc, x, weights, y, Activation::leakyRelu(0.1f), nullptr,
                    nullptr);
    }
    graph.output(y.buffer);
    graph.execute();
    return graph.read<float>(y.buffer);
}

template <class Desc, class Forward>
void checkTiles(Forward forward, const Desc& desc, const TensorDesc& x)
{
    const TensorDesc y = desc.output(x);
    CAPTURE(shapeText(x));
    CAPTURE(shapeText(y));
    const std::vector<float> whole = run(forward, desc, x, nullptr);
    for (float share : {0.5f, 0.0f, 1.0f}) {
        const std::vector<std::uint8_t> mask = randomMask(y, share, y.w + y.h);
        const std::vector<float> got = run(forward, desc, x, &mask);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < got.size(); ++i) {
            const std::size_t row = i / y.w % y.h / gpu::kTileSide;
            const std::size_t tile = row * tileGrid(y).w + i % y.w / gpu::kTileSide;
            wrong += got[i] != (mask[tile] ? whole[i] : kUntouched);
        }
        CHECK_EQ(wrong, 0);
    }
}

} // namespace

TEST_CASE("tiles: active ones have the bits of the whole picture, the others are left alone")
{
    checkTiles(conv2dForward, Conv2dDesc{.in = 5, .out = 19}, {1, 5, 21, 83});
    checkTiles(conv2dForward, Conv2dDesc{.in = 5, .out = 16}, {1, 5, 30, 80});
    checkTiles(conv2dForward, Conv2dDesc{.in = 3, .out = 24}, {1, 3, 24, 88});
    checkTiles(conv2dForward, Conv2dDesc{.in = 1, .out = 272}, {1, 1, 24, 16}); // two dispatches
    checkTiles(conv2dForward, Conv2dDesc{.in = 3, .out = 16, .kernel = {4, 4}, .stride = {2, 2}},
               {1, 3, 48, 160});
    checkTiles(convTranspose2dForward,
               ConvTranspose2dDesc{.in = 5, .out = 16, .kernel = {4, 4}, .padding = {1, 1}},
               {1, 5, 12, 40});
    checkTiles(conv2dForward, Conv2dDesc{.in = 4, .out = 24, .stride = {2, 2}}, {1, 4, 35, 163});
    checkTiles(convTranspose2dForward,
               ConvTranspose2dDesc{.in = 6, .out = 11, .kernel = {4, 4}, .padding = {1, 1}},
               {1, 6, 9, 43});
    checkTiles(convTranspose2dForward, ConvTranspose2dDesc{.in = 3, .out = 17}, {1, 3, 13, 61});
    CHECK_EQ(context().validationMessages(), 0);
}

TEST_CASE("tiles: a kernel that has no form for them is refused by name")
{
    RenderGraph graph(context());
    const Conv2dDesc desc{.in = 1, .out = 1, .kernel = {5, 5}, .padding = {2, 2}};
    const TensorDesc shape{1, 1, 8, 8};
    const TileList tiles = upload(graph, shape, {1});
    const LayerWeights weights{graph.createBuffer("w", 104), 0, 25, true};
    CHECK_THROWS_WITH_AS((void)conv2dForward(graph, "layer nine", desc,
                                             createTensor(graph, "x", shape), weights,
                                             createTensor(graph, "y", shape), {}, &tiles),
                         doctest::Contains("layer nine"), Error);
}
