// Loops at the longest that a kernel accepts are exact; one turn more is refused on the host. (The
// software device would stop them at 65,535 without a word.)
#include <doctest/doctest.h>

#include "compute_nn/conv2d.hpp"
#include "compute_nn/reference/sg_mixture.hpp"
#include "compute_nn/sg_mixture.hpp"
#include "engine/base/error.hpp"
#include "tests/nn/compare.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

// Largest multiple of `step` up to `most` that `build` accepts. Building a graph costs nothing.
template <class Build>
std::uint32_t largestAccepted(std::uint32_t step, std::uint32_t most, Build build)
{
    const auto accepts = [&](std::uint32_t steps) {
        try {
            RenderGraph graph(context());
            build(graph, steps * step);
            return true;
        } catch (const Error&) {
            return false;
        }
    };
    std::uint32_t low = 1, high = most / step + 1;
    REQUIRE(accepts(low));
    REQUIRE_FALSE(accepts(high));
    while (high - low > 1) {
        const std::uint32_t middle = low + (high - low) / 2;
        (accepts(middle) ? low : high) = middle;
    }
    return low * step;
}

} // namespace

TEST_CASE("trip budget: SG mixture at its largest number of lobes and of directions")
{
    const auto forward = [&](RenderGraph& graph, std::uint32_t lobes) {
        const SgMixtureDesc desc{.images = 1, .lobes = lobes, .directions = 1};
        // Lobes of amplitude softplus(0) = ln 2 along the direction itself: every term is the same.
        std::vector<float> raw(lobes * 7, 0.0f);
        for (std::uint32_t l = 0; l < lobes; ++l)
            raw[l * 7 + 2] = 1.0f;
        const std::vector<float> along = {0.0f, 0.0f, 1.0f};
        const TensorId decoded =
            addSgDecodePass(graph, desc, uploadTensor(graph, "raw", desc.raw(), raw));
        return sgMixtureForward(graph, desc, decoded,
                                graph.uploadBuffer("d", std::span<const float>(along)),
                                createTensor(graph, "rgb", {1, 3, 1, 1}));
    };
    const std::uint32_t lobes = largestAccepted(8, 1u << 20, forward);
    CHECK_GE(lobes, 512);
    RenderGraph graph(context());
    const TensorId rgb = forward(graph, lobes);
    graph.output(rgb.buffer);
    graph.run();
    for (const float value : graph.read<float>(rgb.buffer)) // fp32 sums of so many terms
        CHECK_EQ(double(value), doctest::Approx(lobes * std::log(2.0)).epsilon(3e-4));

    const auto backward = [&](RenderGraph& g, std::uint32_t directions) {
        const SgMixtureDesc desc{.images = 1, .lobes = 1, .directions = directions};
        const TensorDesc out{1, 3, 1, directions};
        const std::vector<float> raw = {0, 0, 1, 0, 0, 0, 0}, ones(3 * directions, 1.0f);
        std::vector<float> along(directions * 3, 0.0f);
        for (std::uint32_t d = 0; d < directions; ++d)
            along[d * 3 + 2] = 1.0f;
        return sgMixtureBackward(g, desc, uploadTensor(g, "raw", desc.raw(), raw),
                                 g.uploadBuffer("d", std::span<const float>(along)),
                                 uploadTensor(g, "dOut", out, ones),
                                 createTensor(g, "dRaw", desc.raw()));
    };
    const std::uint32_t directions = largestAccepted(8, 1u << 20, backward);
    RenderGraph second(context());
    const TensorId dRaw = backward(second, directions);
    second.output(dRaw.buffer);
    second.run();
    const std::vector<float> gradient = second.read<float>(dRaw.buffer);
    for (std::size_t c = 4; c < 7; ++c) // sum of ones times sigmoid(0): exact
        CHECK_EQ(gradient[c], 0.5f * float(directions));
}

TEST_CASE("trip budget: a convolution of the most input channels")
{
    const auto build = [&](RenderGraph& graph, std::uint32_t channels) {
        const Conv2dDesc conv{.in = channels, .out = 1, .kernel = {1, 1}, .padding = {0, 0}};
        const std::vector<float> ones(channels + 1, 1.0f);
        const LayerWeights w{graph.uploadBuffer("w", std::span(ones)), 0, channels, true};
        const TensorId x = uploadTensor(graph, "x", {1, channels, 1, 1},
                                        std::span<const float>(ones).first(channels));
        return conv2dForward(graph, "conv", conv, x, w, createTensor(graph, "y", {1, 1, 1, 1}));
    };
    const std::uint32_t channels = largestAccepted(4, 1u << 20, build);
    RenderGraph graph(context());
    const TensorId y = build(graph, channels);
    graph.output(y.buffer);
    graph.run();
    CHECK_EQ(graph.read<float>(y.buffer)[0],
             float(channels + 1)); // whole numbers are exact in fp32
}
