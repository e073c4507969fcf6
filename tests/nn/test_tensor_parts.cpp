// Tensors beyond one binding are worked on in parts: the results are those of a device that binds
// them whole.
#include <doctest/doctest.h>

#include "compute_nn/activation.hpp"
#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"
#include "tests/nn/compare.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

// Every pass of a layer of both kinds, one after the other.
std::vector<std::vector<float>> layerValues(Context& device, const TensorDesc& x, std::uint32_t out)
{
    const Conv2dDesc conv{.in = x.c, .out = out};
    const ConvTranspose2dDesc transpose{
        .in = x.c, .out = out, .kernel = {2, 2}, .stride = {2, 2}, .padding = {0, 0}};
    const TensorDesc y = conv.output(x, "y"), wide = transpose.output(x, "wide");
    RenderGraph graph(device);
    const auto random = [&](const TensorDesc& desc, std::uint32_t seed) {
        return uploadTensor(graph, "t", desc, randomValues<float>(desc.elements(), seed));
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
    for (const BufferId id : results)
        graph.output(id);
    graph.run();
    std::vector<std::vector<float>> values;
    for (const BufferId id : results)
        values.push_back(graph.read<float>(id));
    return values;
}

} // namespace

TEST_CASE("tensor parts: a binding of 128 KiB gives what a larger one gives")
{
    ContextSettings settings{.validation = true};
    settings.device = context().device().name;
    settings.bindingBytes = 128 * 1024;
    Context narrow = Context::headless(settings);
    // By images; by channels of the result, by those of the source, by both.
    const std::pair<TensorDesc, std::uint32_t> cases[] = {
        {{5, 3, 24, 25}, 5}, {{2, 3, 40, 41}, 24}, {{1, 24, 40, 41}, 3}, {{2, 24, 40, 37}, 23}};
    for (const auto& [x, out] : cases) {
        const auto whole = layerValues(context(), x, out), parts = layerValues(narrow, x, out);
        for (std::size_t i = 0; i < whole.size(); ++i) {
            CAPTURE(i);
            CAPTURE(shapeText(x));
            CHECK_LE(relativeError(parts[i], whole[i]), 1e-6); // sums in another order
        }
    }
    CHECK_EQ(narrow.validationMessages(), 0);
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
