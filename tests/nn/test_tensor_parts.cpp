// Tensors beyond one binding are worked on in parts: the results are those of a device that binds
// them whole.
#include <doctest/doctest.h>

#include <algorithm>

#include "compute_nn/activation.hpp"
#include "compute_nn/adam.hpp"
#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"
#include "compute_nn/kernel_filter.hpp"
#include "compute_nn/loss.hpp"
#include "compute_nn/network_shapes.hpp"
#include "compute_nn/sg_mixture.hpp"
#include "compute_nn/tile_list.hpp"
#include "engine/base/error.hpp"
#include "tests/nn/compare.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

Context narrowContext()
{
    ContextSettings settings{.validation = true};
    settings.device = context().device().name;
    settings.bindingBytes = 128 * 1024;
    return Context::headless(settings);
}

using Results = std::vector<std::vector<float>>;

Results valuesOf(RenderGraph& graph, const std::vector<BufferId>& results)
{
    for (const BufferId id : results)
        graph.output(id);
    graph.run();
    Results values;
    for (const BufferId id : results)
        values.push_back(graph.read<float>(id));
    return values;
}

TensorId randomTensor(RenderGraph& graph, const TensorDesc& desc, std::uint32_t seed,
                      float low = -1.2f)
{
    return uploadTensor(graph, "t", desc, randomValues<float>(desc.elements(), seed, low));
}

// Every pass of a layer of both kinds, one after the other.
Results layerValues(Context& device, const TensorDesc& x, std::uint32_t out)
{
    const Conv2dDesc conv{.in = x.c, .out = out};
    const ConvTranspose2dDesc transpose{
        .in = x.c, .out = out, .kernel = {2, 2}, .stride = {2, 2}, .padding = {0, 0}};
    const TensorDesc y = conv.output(x, "y"), wide = transpose.output(x, "wide");
    RenderGraph graph(device);
    const auto random = [&](const TensorDesc& desc, std::uint32_t seed) {
        return randomTensor(graph, desc, seed);
    };
    const auto made = [&](const TensorDesc& desc) { return createTensor(graph, "r", desc); };
    const std::uint32_t weights = x.c * out * 9;
    const auto block = [&](std::uint32_t seed) {
        const std::vector<float> values = randomValues<float>(weights + out, seed);
        return LayerWeights{graph.uploadBuffer("w", std::span<const float>(values)), 0, weights,
                            true};
    };
    const TensorId image = random(x, 1), dY = random(y, 2), dWide = random(wide, 3);
    const LayerWeights w = block(4);
    const Activation leaky = Activation::leakyRelu(0.1f);
    const BackwardEpilogue through{.accumulate = true, .activated = image, .slope = 0.1f};
    const std::vector<BufferId> results = {
        conv2dForward(graph, "a", conv, image, w, made(y), leaky).buffer,
        conv2dBackwardInput(graph, "b", conv, dY, w, random(x, 5), through).buffer,
        conv2dBackwardWeight(graph, "c", conv, image, dY, block(6)),
        convTranspose2dForward(graph, "d", transpose, image, w, made(wide), leaky).buffer,
        convTranspose2dBackwardInput(graph, "e", transpose, dWide, w, random(x, 7), through).buffer,
        convTranspose2dBackwardWeight(graph, "f", transpose, image, dWide, block(8)),
        log1pForward(graph, "g", image, made(x)).buffer,
        activationBackward(graph, "h", {ActivationKind::Softplus}, dY, random(y, 9), random(y, 10))
            .buffer,
    };
    return valuesOf(graph, results);
}

// Images one by one, or of a single image three of the nine planes.
Results kernelFilterValues(Context& device, const TensorDesc& image)
{
    RenderGraph graph(device);
    const TensorDesc wide{image.n, gpu::kFilterTaps + 3, image.h, image.w};
    TensorDesc nine = image;
    nine.c = gpu::kFilterTaps;
    const TensorId logits = channelRange(randomTensor(graph, wide, 1), 3, nine.c);
    const TensorId x = randomTensor(graph, image, 2), dY = randomTensor(graph, image, 3);
    return valuesOf(
        graph,
        {kernelFilterForward(graph, "f", logits, x, createTensor(graph, "y", image)).buffer,
         kernelFilterBackward(graph, "b", logits, x, dY, createTensor(graph, "d", nine)).buffer});
}

Results lossValues(Context& device, LossKind kind)
{
    RenderGraph graph(device);
    const TensorDesc desc{5, 3, 131, 97}; // 11.6 elements a chunk: parts end inside the last
    const BufferId weights = graph.uploadBuffer(
        "weights", std::span<const float>(randomValues<float>(desc.w, 3, 0.1f, 2.0f)));
    const LossResult loss =
        addLossPass(graph, "loss", kind, randomTensor(graph, desc, 1, 0.0f),
                    randomTensor(graph, desc, 2, 0.0f), LossWeights{weights, desc.w, 7});
    return valuesOf(graph, {loss.value, loss.gradient.buffer});
}

Results mixtureValues(Context& device, const SgMixtureDesc& desc)
{
    RenderGraph graph(device);
    const TensorDesc out = desc.planar ? TensorDesc{desc.images, 3, 1, desc.directions}
                                       : TensorDesc{desc.images, desc.directions, 1, 3};
    const std::uint32_t lists = desc.sharedDirections ? 1 : desc.images;
    const BufferId along =
        randomTensor(graph, {lists, desc.directions, 1, 3}, 1).buffer; // need not be unit
    const TensorId raw = randomTensor(graph, desc.raw(), 2);
    const TensorId lobes = addSgDecodePass(graph, desc, raw);
    return valuesOf(
        graph, {sgMixtureForward(graph, desc, lobes, along, createTensor(graph, "rgb", out)).buffer,
                sgMixtureBackward(graph, desc, raw, along, randomTensor(graph, out, 3),
                                  createTensor(graph, "dRaw", desc.raw()))
                    .buffer});
}

// A layer over every second tile of a picture, on top of zeros.
Results tileValues(Context& device, std::uint32_t width)
{
    RenderGraph graph(device);
    const TensorDesc x{1, 24, 40, width};
    const Conv2dDesc conv{.in = 24, .out = 23};
    const TensorDesc y = conv.output(x);
    const Extent2 grid = tileGrid(y);
    std::vector<std::uint32_t> tiles, arguments;
    for (std::uint32_t i = 0; i < grid.h * grid.w; i += 2)
        tiles.push_back(i % grid.w | i / grid.w << 16);
    for (std::uint32_t share = 1; share <= kTilePadding; share *= 2)
        for (std::uint32_t b = 1; b <= gpu::kTileBlocks; ++b)
            arguments.insert(arguments.end(),
                             {std::uint32_t(tiles.size() + share - 1) / share, b, 1});
    tiles.resize(grid.h * grid.w + kTilePadding, ~0u);
    const TileList list{graph.uploadBuffer("tiles", std::span<const std::uint32_t>(tiles)),
                        graph.uploadBuffer("counts", std::span<const std::uint32_t>(arguments))};
    const auto count = std::uint32_t(conv.weightElements());
    const LayerWeights w{
        graph.uploadBuffer("w", std::span<const float>(randomValues<float>(count + conv.out, 2))),
        0, count, true};
    const TensorId before =
        uploadTensor(graph, "y", y, std::vector<float>(std::size_t(y.elements()), 0.0f));
    const TensorId after = conv2dForward(graph, "layer", conv, randomTensor(graph, x, 1), w, before,
                                         Activation::leakyRelu(0.1f), &list);
    return valuesOf(graph, {after.buffer});
}

void checkSameBits(const Results& parts, const Results& whole)
{
    REQUIRE_EQ(parts.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        CAPTURE(i);
        CHECK(sameBits(parts[i], whole[i]));
    }
}

} // namespace

TEST_CASE("tensor parts: a binding of 128 KiB gives what a larger one gives")
{
    Context narrow = narrowContext();
    // By images; by channels of the result, by those of the source, by both.
    const std::pair<TensorDesc, std::uint32_t> cases[] = {
        {{5, 3, 24, 25}, 5},   {{2, 3, 40, 41}, 24},  {{1, 24, 40, 41}, 3},
        {{2, 24, 40, 37}, 23}, {{2, 24, 40, 40}, 24}, {{1, 24, 40, 48}, 16}};
    for (const auto& [x, out] : cases) {
        const auto whole = layerValues(context(), x, out), parts = layerValues(narrow, x, out);
        for (std::size_t i = 0; i < whole.size(); ++i) {
            CAPTURE(i);
            CAPTURE(shapeText(x));
            CHECK_LE(relativeError(parts[i], whole[i]), 2e-6); // sums in another order
        }
    }
    CHECK_EQ(narrow.validationMessages(), 0);
}

TEST_CASE("tensor parts: losses, mixtures and predicted kernels have the bits of the whole")
{
    Context narrow = narrowContext();
    for (const TensorDesc& image : {TensorDesc{7, 4, 33, 65}, TensorDesc{1, 4, 90, 81}}) {
        CAPTURE(shapeText(image));
        checkSameBits(kernelFilterValues(narrow, image), kernelFilterValues(context(), image));
    }
    for (const LossKind kind : {LossKind::MeanSquare, LossKind::Relative, LossKind::Log1p})
        checkSameBits(lossValues(narrow, kind), lossValues(context(), kind));
    for (const SgMixtureDesc& desc :
         {SgMixtureDesc{.images = 1100, .lobes = 8, .directions = 36},
          SgMixtureDesc{.images = 333, .lobes = 3, .directions = 37, .sharedDirections = false},
          SgMixtureDesc{.images = 333, .lobes = 1, .directions = 40, .planar = false}})
        checkSameBits(mixtureValues(narrow, desc), mixtureValues(context(), desc));
    CHECK_EQ(narrow.validationMessages(), 0);
}

TEST_CASE("tensor parts: a list of tiles over parts of the channels")
{
    Context narrow = narrowContext();
    for (const std::uint32_t width : {44u, 48u}) {
        const Results parts = tileValues(narrow, width), whole = tileValues(context(), width);
        CHECK_LE(relativeError(parts[0], whole[0]), 1e-6); // sums in another order
        CHECK_EQ(std::count(parts[0].begin(), parts[0].end(), 0.0f),
                 std::count(whole[0].begin(), whole[0].end(), 0.0f));
    }
    CHECK_EQ(narrow.validationMessages(), 0);
}

TEST_CASE("tensor parts: a NaN is found in whichever part")
{
    Context narrow = narrowContext();
    constexpr std::uint32_t kCount = 100000;
    const std::pair<std::uint32_t, std::uint32_t> cases[] = {
        {77, 77}, {77, 32780}, {77, 65536}, {77, 99999}, {77, 76},    {77, 100000},
        {76, 76}, {76, 32779}, {76, 99999}, {76, 75},    {76, 100000}}; // of 76 whole quads
    for (const auto& [first, place] : cases) {
        Parameters parameters(
            narrow, UNetDesc{.in = 1, .out = 1, .head = 0, .down = {2}, .up = {2}}.parameters(), 1);
        RenderGraph graph(narrow);
        ParameterIds ids(graph, parameters);
        std::vector<float> values(kCount + 1, 1.0f);
        values[place] = NAN;
        ids.clearGradients(graph);
        ids.checkFinite(graph, "values", graph.uploadBuffer("v", std::span<const float>(values)),
                        first, kCount - first, 2.0f);
        addAdamPass(graph, ids, {}, 1);
        graph.run();
        CAPTURE(first);
        CAPTURE(place);
        CHECK_EQ(parameters.report().stepsSkipped, place >= first && place < kCount ? 1u : 0u);
    }
}

TEST_CASE("tensor parts: what no part of can be bound is refused by name")
{
    Context narrow = narrowContext();
    RenderGraph graph(narrow);
    const TensorDesc image{1, 4, 100, 100}, nine{1, 9, 100, 100};
    CHECK_THROWS_WITH_AS(
        (void)kernelFilterForward(graph, "filter six", createTensor(graph, "logits", nine),
                                  createTensor(graph, "x", image), createTensor(graph, "y", image)),
        doctest::Contains("filter six"), Error);
    const SgMixtureDesc desc{.images = 65, .lobes = 2, .directions = 300};
    CHECK_THROWS_WITH_AS((void)sgMixtureForward(graph, desc,
                                                createTensor(graph, "lobes", desc.raw()),
                                                graph.createBuffer("directions", 3600),
                                                createTensor(graph, "rgb", {65, 3, 1, 300})),
                         doctest::Contains("sg mixture"), Error);
}

TEST_CASE("tensor parts: a result of 144 MB, more than many devices bind")
{
    const TensorDesc x{1, 1, 1500, 1500};
    const Conv2dDesc conv{
        .in = 1, .out = 16, .kernel = {1, 1}, .stride = {1, 1}, .padding = {0, 0}};
    const std::vector<float> values = randomValues<float>(x.elements(), 1);
    const std::vector<float> parameters = randomValues<float>(32, 2);
    RenderGraph graph(context());
    const LayerWeights w{graph.uploadBuffer("w", std::span<const float>(parameters)), 0, 16, true};
    const TensorDesc y = conv.output(x, "y");
    const TensorId result = conv2dForward(graph, "large", conv, uploadTensor(graph, "x", x, values),
                                          w, createTensor(graph, "y", y));
    graph.output(result.buffer);
    graph.run();
    const std::vector<float> got = graph.read<float>(result.buffer);
    REQUIRE(got.size() == y.elements());
    double worst = 0.0;
    for (std::size_t i = 0; i < got.size(); i += 997) {
        const std::size_t channel = i / x.pixels(), pixel = i % x.pixels();
        const double expected =
            double(parameters[channel]) * double(values[pixel]) + double(parameters[16 + channel]);
        worst = std::max(worst, std::abs(double(got[i]) - expected));
    }
    CHECK_LE(worst, 3e-7); // two roundings of values up to 2.7
    CHECK_EQ(context().validationMessages(), 0);
}
