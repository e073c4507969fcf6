// Activations stored as halves: layers and whole networks against the double twin, to what one
// rounding a stored value explains; values that no half holds are found and named.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>

#include "compute_nn/activation.hpp"
#include "compute_nn/half_guard.hpp"
#include "compute_nn/unet.hpp"
#include "engine/base/error.hpp"
#include "tests/nn/compare.hpp"
#include "tests/nn/conv_cases.hpp"
#include "tests/nn/layer_case.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

// A device may round to the nearest half, 2^-11 off, or towards zero, 2^-10; and below 2^-14 halves
// are 2^-24 apart.
constexpr double kRounding = 0x1p-10, kSmallest = 0x1p-24;

bool unavailable()
{
    const std::string& missing = context().device().missingForHalves;
    if (!missing.empty())
        MESSAGE("no halves: the device lacks " << missing);
    return !missing.empty();
}

std::vector<double> halvesToDoubles(const std::vector<std::uint16_t>& halves, std::size_t count)
{
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i)
        values.push_back(double(glm::unpackHalf1x16(halves[i])));
    return values;
}

// Halves of what the twin reads too, so that only the stores round.
std::vector<float> exactHalves(std::size_t count, std::uint32_t seed)
{
    std::vector<float> values = randomValues<float>(count, seed);
    for (float& v : values)
        v = glm::unpackHalf1x16(glm::packHalf1x16(v));
    return values;
}

template <class Ops, class Desc> void checkLayer(const Desc& desc, const TensorDesc& xDesc)
{
    const TensorDesc yDesc = desc.output(xDesc);
    CAPTURE(shapeText(xDesc));
    CAPTURE(shapeText(yDesc));
    const auto count = std::uint32_t(desc.weightElements());
    const std::vector<float> x = exactHalves(xDesc.elements(), 1);
    const std::vector<float> w = randomValues<float>(count + desc.out, 2);
    RenderGraph graph(context());
    HalfGuard guard(graph);
    const LayerWeights weights{graph.uploadBuffer("w", std::span(w)), 0, count, true};
    const TensorId source = storeAsHalves(graph, "x", uploadTensor(graph, "x", xDesc, x),
                                          createTensor(graph, "x", xDesc, Element::Half));
    const auto layer = [&](Element element) {
        return Ops::forward(graph, "layer", desc, source, weights,
                            createTensor(graph, "y", yDesc, element), Activation::leakyRelu(0.25f),
                            nullptr, &guard)
            .buffer;
    };
    const BufferId halves = layer(Element::Half), floats = layer(Element::Float);
    graph.output(halves);
    graph.output(floats);
    guard.output(graph);
    graph.run();
    CHECK_NOTHROW(guard.check(graph));

    std::vector<double> y(yDesc.elements());
    const std::vector<double> wide = convert<double>(w);
    Ops::twin(desc, xDesc, convert<double>(x), std::span(wide).first(count),
              std::span(wide).subspan(count), y);
    for (double& v : y)
        v = reference::activate(Activation::leakyRelu(0.25f), v);
    const std::vector<double> got =
        halvesToDoubles(graph.read<std::uint16_t>(halves), yDesc.elements());
    double worst = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) // fp32 sums are within 2e-5, as in test_ops.cpp
        worst = std::max(worst, (std::abs(got[i] - y[i]) - 2e-5) /
                                    (std::abs(y[i]) * kRounding + kSmallest));
    CHECK_LE(worst, 1.0);
    CHECK_LE(relativeError(graph.read<float>(floats), y), 5e-6); // nothing was rounded
}

struct Network
{
    UNetDesc net;
    Parameters parameters;
    std::vector<float> x;
    TensorDesc shape;
};

Network makeNetwork(const UNetDesc& net)
{
    const std::uint32_t side = 1u << net.levels();
    const TensorDesc shape{1, net.in, 3 * side, 5 * side};
    return {net, Parameters(context(), net.parameters(), 3), exactHalves(shape.elements(), 4),
            shape};
}

std::vector<float> runNetwork(Network& n, bool halves)
{
    RenderGraph graph(context());
    const ParameterIds ids(graph, n.parameters);
    std::optional<HalfGuard> guard;
    if (halves)
        guard.emplace(graph);
    const UNetValues values = unetForward(graph, n.net, ids, uploadTensor(graph, "x", n.shape, n.x),
                                          nullptr, guard ? &*guard : nullptr);
    graph.output(values.y.buffer);
    if (guard)
        guard->output(graph);
    graph.run();
    if (guard)
        guard->check(graph);
    return graph.read<float>(values.y.buffer);
}

} // namespace

TEST_CASE("halves: a layer's values are rounded once")
{
    if (unavailable())
        return;
    // The gather, and the row kernels with and without whole quads.
    for (const ConvCase& c : {makeConvCase({2, 5, 6, 7}, 9, {3, 2}, {3, 2}, {1, 1}, {2, 1}),
                              makeConvCase({1, 8, 5, 16}, 8, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
                              makeConvCase({1, 5, 6, 23}, 8, {2, 2}, {2, 2}, {0, 0}, {0, 0})}) {
        checkLayer<ConvOps>(c.conv, c.x);
        checkLayer<ConvTransposeOps>(c.transpose, c.x);
    }
    CHECK_EQ(context().validationMessages(), 0);
}

TEST_CASE("halves: a network is as near to floats as its stored values, and repeats its bits")
{
    if (unavailable())
        return;
    for (const UNetDesc& net :
         {UNetDesc{.in = 5, .head = 8, .down = {8}, .up = {8}},
          UNetDesc{.in = 5, .head = 0, .down = {8, 8}, .up = {8, 8}, .upKernel = 4}}) {
        Network n = makeNetwork(net);
        const std::vector<float> floats = runNetwork(n, false), halves = runNetwork(n, true);
        // Each of the 2 levels + 1 stores on the way adds a rounding of its own in the norm.
        CHECK_LE(relativeError(halves, floats), kRounding * (2.0 * net.levels() + 1.0));
        CHECK_GT(relativeError(halves, floats), 0x1p-16); // they were stored as halves
        CHECK(sameBits(halves, runNetwork(n, true)));
    }
    CHECK_EQ(context().validationMessages(), 0);
}

TEST_CASE("halves: a value beyond 65504 and a NaN are found, and the layer named")
{
    if (unavailable())
        return;
    for (const float bad : {3e5f, INFINITY, NAN}) {
        CAPTURE(bad);
        Network n = makeNetwork(UNetDesc{.in = 2, .head = 0, .down = {4, 4}, .up = {4, 4}});
        std::vector<float> values = n.parameters.download();
        const ParameterSlice& bias = n.parameters.layout().slice("dec1.bias");
        values[bias.offset + 1] = bad;
        n.parameters.upload(values);
        CHECK_NOTHROW(runNetwork(n, false));
        CHECK_THROWS_WITH_AS(runNetwork(n, true), doctest::Contains("layer dec1"), Error);
    }
}
