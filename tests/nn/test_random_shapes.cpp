// Convolutions of both kinds, forward and all gradients, over random shapes: values against the
// double twin, and the same bits twice and for any number of threads.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <span>
#include <string>
#include <thread>

#include "tests/nn/conv_cases.hpp"
#include "tests/nn/layer_case.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

constexpr std::uint32_t kShapes = 200;
constexpr std::size_t kLayersOfGraph = 50; // submits cost more than such dispatches
constexpr std::size_t kLayersOnThreads = 50;

struct Layer
{
    std::string name;
    std::function<LayerResults(RenderGraph&)> add;
    std::function<std::vector<Output>(const RenderGraph&, const LayerResults&)> read;
    std::function<std::vector<ExpectedOutput>()> twin;
};

template <class Ops, class Desc> Layer makeLayer(const LayerCase<Desc>& c)
{
    return {
        layerName<Ops>(c), [c](RenderGraph& graph) { return addLayerPasses<Ops>(graph, c); },
        [c](const RenderGraph& graph, const LayerResults& ids) { return readLayer(graph, ids, c); },
        [c] { return layerTwin<Ops>(c); }};
}

std::vector<Layer> randomLayers()
{
    std::vector<Layer> layers;
    std::uint32_t i = 0;
    for (const ConvCase& c : randomConvCases(kShapes)) {
        const bool ranges = i % 3 == 2;
        const std::uint32_t seed = 5000 + 20 * i++;
        layers.push_back(makeLayer<ConvOps>(
            LayerCase<Conv2dDesc>{c.conv, c.x, c.conv.output(c.x), true, ranges, seed}));
        layers.push_back(makeLayer<ConvTransposeOps>(LayerCase<ConvTranspose2dDesc>{
            c.transpose, c.x, c.transpose.output(c.x), true, ranges, seed + 10}));
    }
    return layers;
}

std::vector<std::vector<Output>> runLayers(Context& device, std::span<const Layer> layers)
{
    std::vector<std::vector<Output>> values;
    for (std::size_t first = 0; first < layers.size(); first += kLayersOfGraph) {
        RenderGraph graph(device);
        const std::size_t end = std::min(first + kLayersOfGraph, layers.size());
        std::vector<LayerResults> ids;
        for (std::size_t i = first; i < end; ++i)
            ids.push_back(layers[i].add(graph));
        graph.execute();
        for (std::size_t i = first; i < end; ++i)
            values.push_back(layers[i].read(graph, ids[i - first]));
    }
    return values;
}

// A second device of another number of threads, where it is the software one: that reads its
// environment when an instance is made.
Context deviceOfThreads(unsigned threads)
{
    const char* before = std::getenv("LP_NUM_THREADS");
    const std::string old = before ? before : "";
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    Context device = Context::headless({.device = context().device().name});
    before ? setenv("LP_NUM_THREADS", old.c_str(), 1) : unsetenv("LP_NUM_THREADS");
    return device;
}

} // namespace

TEST_CASE("convolutions over 200 random shapes: the double twin's values; the same bits twice and "
          "for another number of threads")
{
    const std::vector<Layer> layers = randomLayers();
    REQUIRE_EQ(layers.size(), 2 * kShapes);
    // One thread, and two where that is the default.
    Context other = deviceOfThreads(std::thread::hardware_concurrency() > 1 ? 1 : 2);
    const std::vector<std::vector<Output>> once = runLayers(context(), layers);
    const std::vector<std::vector<Output>> twice = runLayers(context(), layers);
    // Threads share out workgroups, whatever the shape; and a device compiles its kernels anew.
    const std::vector<std::vector<Output>> threads =
        runLayers(other, std::span(layers).last(kLayersOnThreads));
    double worst = 0.0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        CAPTURE(layers[i].name);
        const std::vector<ExpectedOutput> wanted = layers[i].twin();
        for (std::size_t k = 0; k < wanted.size(); ++k) {
            worst = std::max(worst, checkOutput(once[i][k], wanted[k]));
            CHECK(sameBits(once[i][k].values, twice[i][k].values));
            if (i >= layers.size() - kLayersOnThreads)
                CHECK(sameBits(once[i][k].values,
                               threads[i + kLayersOnThreads - layers.size()][k].values));
        }
    }
    MESSAGE(layers.size() << " layers of " << kShapes
                          << " shapes with all their gradients, at most " << worst
                          << " off in the norm");
    CHECK_EQ(context().validationMessages(), 0);
}
