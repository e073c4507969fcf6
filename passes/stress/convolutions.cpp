// Convolutions and transposed convolutions under stress: random shapes and scales through the
// public passes, forward and all gradients. Errors are judged by sum |a b|, what fp32 promises;
// cancellation may not matter.
#include <array>
#include <cmath>

#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"
#include "compute_nn/reference/conv2d.hpp"
#include "passes/stress/inputs.hpp"
#include "passes/stress/kernel_inputs.hpp"
#include "passes/stress/tally.hpp"

namespace strandlight {

namespace {

// Both kinds of layer; of the two descriptions one is used.
struct Layer
{
    bool transposed = false;
    TensorDesc x, y;
    Conv2dDesc conv;
    ConvTranspose2dDesc transpose;
    std::uint64_t weights() const
    {
        return transposed ? transpose.weightElements() : conv.weightElements();
    }
    std::string text() const
    {
        const Extent2& k = conv.kernel;
        return std::string(transposed ? "transposed " : "") + shapeText(x) + " to " + shapeText(y) +
               ", kernel " + std::to_string(k.h) + "x" + std::to_string(k.w) + ", stride " +
               std::to_string(conv.stride.h) + "x" + std::to_string(conv.stride.w) + ", padding " +
               std::to_string(conv.padding.h) + "x" + std::to_string(conv.padding.w);
    }
};

Layer randomLayer(std::uint32_t seed, std::uint32_t i)
{
    StressRandom r(seed, i);
    Layer layer;
    layer.transposed = i % 2 == 1;
    Extent2 kernel = {r.integer(1, 5), r.integer(1, 5)},
            stride = {r.integer(1, 3), r.integer(1, 3)};
    if (r.uniform() < 0.5f) { // what networks are made of
        kernel = layer.transposed ? Extent2{2, 2} : Extent2{3, 3};
        stride = layer.transposed ? Extent2{2, 2} : Extent2{r.integer(1, 2), 0};
        stride.w = stride.h;
    }
    const Extent2 padding = {kernel.h / 2, kernel.w / 2};
    layer.x = {r.integer(1, 3), r.integer(1, 40), r.integer(kernel.h, 14), r.integer(kernel.w, 14)};
    const std::uint32_t out = r.integer(1, 40);
    layer.conv = {
        .in = layer.x.c, .out = out, .kernel = kernel, .stride = stride, .padding = padding};
    layer.transpose = {.in = layer.x.c,
                       .out = out,
                       .kernel = kernel,
                       .stride = stride,
                       .padding = kernel == Extent2{2, 2} ? Extent2{0, 0} : padding};
    if (layer.transposed)
        layer.conv.padding = layer.transpose.padding;
    layer.y = layer.transposed ? layer.transpose.output(layer.x) : layer.conv.output(layer.x);
    return layer;
}

struct LayerTensors
{
    std::vector<float> x, dY, block; // block: weights, then bias
};

// y, dX, gradient block
using LayerResults = std::array<std::vector<float>, 3>;

LayerResults runLayer(Context& context, const Layer& l, const LayerTensors& in)
{
    RenderGraph graph(context);
    const std::uint32_t bias = std::uint32_t(l.weights());
    const std::vector<float> zeros(in.block.size(), 0.0f);
    const TensorId x = uploadTensor(graph, "x", l.x, in.x),
                   dY = uploadTensor(graph, "dY", l.y, in.dY);
    const LayerWeights w{graph.uploadBuffer("w", std::span(in.block)), 0, bias, true};
    LayerWeights dW = w;
    dW.block = graph.uploadBuffer("dW", std::span(zeros));
    TensorId y = createTensor(graph, "y", l.y), dX = createTensor(graph, "dX", l.x);
    if (l.transposed) {
        y = convTranspose2dForward(graph, "y", l.transpose, x, w, y);
        dX = convTranspose2dBackwardInput(graph, "dX", l.transpose, dY, w, dX);
        dW.block = convTranspose2dBackwardWeight(graph, "dW", l.transpose, x, dY, dW);
    } else {
        y = conv2dForward(graph, "y", l.conv, x, w, y);
        dX = conv2dBackwardInput(graph, "dX", l.conv, dY, w, dX);
        dW.block = conv2dBackwardWeight(graph, "dW", l.conv, x, dY, dW);
    }
    for (const BufferId id : {y.buffer, dX.buffer, dW.block})
        graph.output(id);
    graph.run();
    return {graph.read<float>(y.buffer), graph.read<float>(dX.buffer), graph.read<float>(dW.block)};
}

std::array<std::vector<double>, 3> layerInDouble(const Layer& l, const std::vector<double>& x,
                                                 const std::vector<double>& dY,
                                                 const std::vector<double>& block)
{
    const auto weight = std::span(block).first(l.weights()),
               bias = std::span(block).subspan(l.weights());
    std::vector<double> y(l.y.elements()), dX(x.size(), 0.0), dW(block.size(), 0.0);
    const auto dWeight = std::span(dW).first(l.weights()),
               dBias = std::span(dW).subspan(l.weights());
    if (l.transposed) {
        reference::convTranspose2d<double>(l.transpose, l.x, x, weight, bias, y);
        reference::convTranspose2dBackward<double>(l.transpose, l.x, x, weight, dY, dX, dWeight,
                                                   dBias);
    } else {
        reference::conv2d<double>(l.conv, l.x, x, weight, bias, y);
        reference::conv2dBackward<double>(l.conv, l.x, x, weight, dY, dX, dWeight, dBias);
    }
    return {y, dX, dW};
}

void stressLayers(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    constexpr double kPerRoot = 2e-7; // of sqrt(K) sum |a b|, K terms
    std::array<Tally, 3> tally = {
        Tally("convolutions, forward, device", kPerRoot, "sqrt(K) sum |a b|"),
        Tally("convolutions, data gradient, device", kPerRoot, "sqrt(K) sum |a b|"),
        Tally("convolutions, weight gradient, device", kPerRoot, "sqrt(K) sum |a b|")};
    for (std::uint32_t i = 0; i < s.shapes; ++i) {
        const Layer layer = randomLayer(s.seed + 80, i);
        const std::array<float, 3> scales = {1.0f, 1e-6f, 1e4f};
        const float scale = scales[i % 3];
        LayerTensors in;
        in.x = stressTensor(layer.x.elements(), s.seed + 81 + i, scale);
        in.dY = stressTensor(layer.y.elements(), s.seed + 82 + i);
        in.block = stressTensor(layer.weights() + layer.y.c, s.seed + 83 + i, i % 2 ? 1.0f : scale);
        const LayerResults got = runLayer(context, layer, in);
        const auto expected =
            layerInDouble(layer, toDouble(in.x), toDouble(in.dY), toDouble(in.block));
        const auto sums =
            layerInDouble(layer, magnitudes(in.x), magnitudes(in.dY), magnitudes(in.block));
        const double taps = double(layer.conv.kernel.h) * layer.conv.kernel.w;
        const std::array<double, 3> terms = {taps * layer.x.c + 1.0, taps * layer.y.c,
                                             double(layer.x.n) *
                                                 std::max(layer.x.pixels(), layer.y.pixels())};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t e = 0; e < expected[k].size(); ++e)
                tally[k].compare(double(got[k][e]), expected[k][e],
                                 std::sqrt(terms[k]) * sums[k][e] + 1e-37,
                                 [&] { return layer.text() + ", element " + std::to_string(e); });
    }
    for (const Tally& t : tally)
        rows.push_back(t.row());
}

} // namespace

std::vector<StressRow> stressConvolutions(Context& context, const StressSettings& settings)
{
    std::vector<StressRow> rows;
    stressLayers(context, settings, rows);
    return rows;
}

} // namespace strandlight
