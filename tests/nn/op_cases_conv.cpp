#include "tests/nn/op_cases.hpp"

#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"
#include "compute_nn/reference/activation.hpp"
#include "compute_nn/reference/conv2d.hpp"
#include "tests/nn/compare.hpp"
#include "tests/nn/conv_cases.hpp"

namespace strandlight::test {

namespace {

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

TensorId rangeOf(const TensorId& whole, bool ranges, std::uint32_t first, std::uint32_t count)
{
    return ranges ? channelRange(whole, first, count) : whole;
}

struct ConvOps
{
    static constexpr auto forward = conv2dForward;
    static constexpr auto backwardInput = conv2dBackwardInput;
    static constexpr auto backwardWeight = conv2dBackwardWeight;
    static constexpr auto twin = reference::conv2d<double>;
    static constexpr auto twinBackward = reference::conv2dBackward<double>;
};
struct ConvTransposeOps
{
    static constexpr auto forward = convTranspose2dForward;
    static constexpr auto backwardInput = convTranspose2dBackwardInput;
    static constexpr auto backwardWeight = convTranspose2dBackwardWeight;
    static constexpr auto twin = reference::convTranspose2d<double>;
    static constexpr auto twinBackward = reference::convTranspose2dBackward<double>;
};

template <class Ops, class Desc>
std::vector<Output> runOnDevice(Context& context, const LayerCase<Desc>& c)
{
    RenderGraph graph(context);
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
                     nullptr);
    dX = Ops::backwardInput(graph, "dX", c.desc, dY, weights, dX,
                            {.accumulate = true, .activated = x, .slope = c.kSlope});
    gradient.block = Ops::backwardWeight(graph, "dW", c.desc, x, dY, gradient);
    for (BufferId id : {y.buffer, dX.buffer, gradient.block})
        graph.output(id);
    graph.execute();
    return {{"y", c.part(graph.read<float>(y.buffer), c.y, 1)},
            {"dX", c.part(graph.read<float>(dX.buffer), c.x, 2)},
            {"dW and dB", graph.read<float>(gradient.block)}};
}

template <class Ops, class Desc> std::vector<ExpectedOutput> runTwin(const LayerCase<Desc>& c)
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

template <class Ops, class Desc>
void addLayer(std::vector<OpCase>& cases, const char* op, const LayerCase<Desc>& c)
{
    cases.push_back({std::string(op) + " " + shapeText(c.x) + " -> " + shapeText(c.y),
                     [c](Context& context) { return runOnDevice<Ops>(context, c); },
                     [c] { return runTwin<Ops>(c); }});
}

} // namespace

namespace {

// Both directions of one shape.
void addShape(std::vector<OpCase>& cases, const ConvCase& c, bool bias, bool ranges,
              std::uint32_t seed)
{
    addLayer<ConvOps>(cases, "conv2d",
                      LayerCase<Conv2dDesc>{c.conv, c.x, c.conv.output(c.x), bias, ranges, seed});
    // The padding may exceed what a transposed kernel covers; such a layer has no output.
    const ConvTranspose2dDesc& t = c.transpose;
    if ((c.x.h - 1) * t.stride.h + t.kernel.h + t.outputPadding.h <= 2 * t.padding.h ||
        (c.x.w - 1) * t.stride.w + t.kernel.w + t.outputPadding.w <= 2 * t.padding.w)
        return;
    addLayer<ConvTransposeOps>(
        cases, "conv_transpose2d",
        LayerCase<ConvTranspose2dDesc>{t, c.x, t.output(c.x), bias, ranges, seed + 5});
}

} // namespace

void addSubgroupCases(std::vector<OpCase>& cases)
{
    for (const ConvCase& c : {makeConvCase({2, 6, 9, 7}, 13, {3, 3}, {2, 2}, {1, 1}, {0, 0}),
                              makeConvCase({1, 5, 6, 23}, 11, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
                              makeConvCase({1, 5, 3, 12}, 11, {3, 3}, {1, 1}, {1, 1}, {0, 0})})
        addShape(cases, c, true, true, 3);
}

void addGpuFormCases(std::vector<OpCase>& cases)
{
    std::uint32_t seed = 500;
    for (const ConvCase& c : convCases(12))
        addShape(cases, c, true, false, seed += 10);
    for (const ConvCase& c : {makeConvCase({1, 3, 9, 71}, 33, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
                              makeConvCase({2, 19, 8, 36}, 12, {4, 4}, {2, 2}, {1, 1}, {0, 0}),
                              makeConvCase({1, 33, 5, 20}, 3, {3, 3}, {2, 2}, {1, 1}, {1, 1})})
        addShape(cases, c, true, true, seed += 10);
}

void addConvCases(std::vector<OpCase>& cases)
{
    std::uint32_t seed = 100;
    const auto add = [&](const ConvCase& c) {
        seed += 10;
        addShape(cases, c, seed % 40 != 0, seed % 30 == 0, seed);
    };
    for (const ConvCase& c : convCases(36))
        add(c);
    for (const ConvCase& c : rowConvCases())
        add(c);
    for (const ConvCase& c : quadConvCases())
        add(c);
    // Many small images, as the encoder has them; and more pixels than one strip of the weight
    // gradient.
    add(makeConvCase({257, 5, 2, 2}, 9, {3, 3}, {2, 2}, {1, 1}, {0, 0}));
    add(makeConvCase({1, 3, 61, 151}, 4, {3, 3}, {1, 1}, {1, 1}, {0, 0}));
}

} // namespace strandlight::test
