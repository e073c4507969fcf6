// One convolution layer of either kind with everything it can do, on the device and by its twin.
#pragma once

#include <string>
#include <vector>

#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"
#include "compute_nn/reference/activation.hpp"
#include "compute_nn/reference/conv2d.hpp"
#include "tests/nn/compare.hpp"
#include "tests/nn/op_cases.hpp"

namespace strandlight::test {

// Everything one layer can do at once: x and y are channel ranges inside larger buffers, the
// forward pass ends with a leaky relu, the data gradient adds to what is there and goes back
// through the leaky relu that made x.
template <class Desc> struct LayerCase
{
    Desc desc;
    TensorDesc x, y;
    bool bias = true;
    bool ranges = false; // x has 2 channels before and 1 behind, y 1 before and 2 behind
    std::uint32_t seed = 1;
    static constexpr float kSlope = 0.25f;

    TensorDesc wide(const TensorDesc& d) const
    {
        return ranges ? TensorDesc{d.n, d.c + 3, d.h, d.w} : d;
    }
    template <class T> std::vector<T> values(std::size_t count, std::uint32_t stream) const
    {
        return randomValues<T>(count, seed + stream);
    }
    // The range's values out of a wide tensor's.
    template <class T>
    std::vector<T> part(const std::vector<T>& all, const TensorDesc& d, std::uint32_t first) const
    {
        std::vector<T> range(d.elements());
        const std::size_t plane = d.pixels();
        for (std::size_t i = 0; i < range.size(); ++i) {
            const std::size_t n = i / (plane * d.c), r = i % (plane * d.c);
            range[i] = all[n * plane * wide(d).c + (ranges ? first : 0) * plane + r];
        }
        return range;
    }
};

inline TensorId rangeOf(const TensorId& whole, bool ranges, std::uint32_t first,
                        std::uint32_t count)
{
    return ranges ? channelRange(whole, first, count) : whole;
}

struct ConvOps
{
    static constexpr const char* name = "conv2d";
    static constexpr auto forward = conv2dForward;
    static constexpr auto backwardInput = conv2dBackwardInput;
    static constexpr auto backwardWeight = conv2dBackwardWeight;
    static constexpr auto twin = reference::conv2d<double>;
    static constexpr auto twinBackward = reference::conv2dBackward<double>;
};
struct ConvTransposeOps
{
    static constexpr const char* name = "conv_transpose2d";
    static constexpr auto forward = convTranspose2dForward;
    static constexpr auto backwardInput = convTranspose2dBackwardInput;
    static constexpr auto backwardWeight = convTranspose2dBackwardWeight;
    static constexpr auto twin = reference::convTranspose2d<double>;
    static constexpr auto twinBackward = reference::convTranspose2dBackward<double>;
};

// The layer's passes in a graph, and where their results are.
struct LayerResults
{
    BufferId y, dX, gradient;
};

template <class Ops, class Desc>
LayerResults addLayerPasses(RenderGraph& graph, const LayerCase<Desc>& c)
{
    const auto upload = [&](const char* name, const TensorDesc& d, std::uint32_t stream) {
        const TensorDesc all = c.wide(d);
        return uploadTensor(graph, name, all, c.template values<float>(all.elements(), stream));
    };
    const TensorId x = rangeOf(upload("x", c.x, 0), c.ranges, 2, c.x.c);
    const TensorId dY = rangeOf(upload("dY", c.y, 1), c.ranges, 1, c.y.c);
    TensorId y = rangeOf(upload("y", c.y, 2), c.ranges, 1, c.y.c);   // overwritten
    TensorId dX = rangeOf(upload("dX", c.x, 3), c.ranges, 2, c.x.c); // added to
    const std::uint32_t count = std::uint32_t(c.desc.weightElements());
    const std::vector<float> block = c.template values<float>(count + c.desc.out, 4);
    const std::vector<float> old = c.template values<float>(count + c.desc.out, 5);
    const LayerWeights weights{graph.uploadBuffer("weights", std::span(block)), 0, count, c.bias};
    LayerWeights gradient{graph.uploadBuffer("gradient", std::span(old)), 0, count, c.bias};

    y = Ops::forward(graph, "forward", c.desc, x, weights, y, Activation::leakyRelu(c.kSlope),
                     nullptr, nullptr);
    dX = Ops::backwardInput(graph, "dX", c.desc, dY, weights, dX,
                            {.accumulate = true, .activated = x, .slope = c.kSlope});
    gradient.block = Ops::backwardWeight(graph, "dW", c.desc, x, dY, gradient);
    for (BufferId id : {y.buffer, dX.buffer, gradient.block})
        graph.output(id);
    return {y.buffer, dX.buffer, gradient.block};
}

template <class Desc>
std::vector<Output> readLayer(const RenderGraph& graph, const LayerResults& ids,
                              const LayerCase<Desc>& c)
{
    return {{"y", c.part(graph.read<float>(ids.y), c.y, 1)},
            {"dX", c.part(graph.read<float>(ids.dX), c.x, 2)},
            {"dW and dB", graph.read<float>(ids.gradient)}};
}

template <class Ops, class Desc> std::vector<ExpectedOutput> layerTwin(const LayerCase<Desc>& c)
{
    const auto values = [&](const TensorDesc& d, std::uint32_t stream, std::uint32_t first) {
        return c.part(c.template values<double>(c.wide(d).elements(), stream), d, first);
    };
    const std::vector<double> x = values(c.x, 0, 2), dY = values(c.y, 1, 1);
    std::vector<double> y(c.y.elements()), dX = values(c.x, 3, 2);
    const std::size_t count = c.desc.weightElements();
    const std::vector<double> block = c.template values<double>(count + c.desc.out, 4);
    std::vector<double> gradient = c.template values<double>(count + c.desc.out, 5);
    const std::span<const double> all(block);
    const auto w = all.first(count), b = c.bias ? all.subspan(count) : std::span<const double>();
    const std::span<double> d(gradient);
    Ops::twin(c.desc, c.x, x, w, b, y);
    for (double& v : y)
        v = reference::activate(Activation::leakyRelu(c.kSlope), v);
    Ops::twinBackward(c.desc, c.x, x, w, dY, dX, d.first(count),
                      c.bias ? d.subspan(count) : std::span<double>());
    for (std::size_t i = 0; i < dX.size(); ++i)
        dX[i] *= reference::activationDerivative(Activation::leakyRelu(c.kSlope), x[i]);
    return {{"y", y}, {"dX", dX}, {"dW and dB", gradient}};
}

template <class Ops, class Desc> std::string layerName(const LayerCase<Desc>& c)
{
    const auto text = [](const Extent2& e) {
        return std::to_string(e.h) + "x" + std::to_string(e.w);
    };
    return std::string(Ops::name) + " " + shapeText(c.x) + " -> " + shapeText(c.y) + ", kernel " +
           text(c.desc.kernel) + ", stride " + text(c.desc.stride) + ", padding " +
           text(c.desc.padding);
}

} // namespace strandlight::test
