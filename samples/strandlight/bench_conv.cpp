// Convolution cases of `strandlight bench kernels`. Outputs are checked one by one at scattered
// places: the whole twin would take longer than all timings.
#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"
#include "kernels/bench.gen.hpp"
#include "samples/strandlight/bench_conv_twin.hpp"
#include "samples/strandlight/bench_kernels.hpp"
#include "shaders/shared/bench_types.h"

namespace strandlight::cli {

namespace {

constexpr std::uint32_t kSamples = 512;      // outputs compared
constexpr std::uint32_t kWeightSamples = 24; // weight gradients compared: each sums all pixels
constexpr std::uint32_t kNaiveRounds = 3;    // two seconds each

// A convolution on an image of this size; `quick` makes it smaller.
template <class Desc> struct ConvCase
{
    Desc desc;
    std::uint32_t width = 0;
    std::uint32_t height = 0;

    TensorDesc input(bool quick) const
    {
        return {1, desc.in, quick ? height / 4 : height, quick ? width / 4 : width};
    }
};

template <class Desc> std::string nameOf(const ConvCase<Desc>& c)
{
    const Desc& d = c.desc;
    std::string name = std::to_string(d.kernel.h) + "x" + std::to_string(d.kernel.w);
    if (d.stride.h != 1)
        name += " s" + std::to_string(d.stride.h);
    return name + " " + std::to_string(d.in) + "->" + std::to_string(d.out) + " " +
           std::to_string(c.width) + "x" + std::to_string(c.height);
}

// Random input, weights and bias of a case, on the host and in a graph.
struct ConvData
{
    template <class Desc>
    ConvData(const Desc& desc, const TensorDesc& x)
        : xDesc(x), yDesc(desc.output(x)), input(randomValues(x.elements(), 1)),
          weights(randomValues(desc.weightElements() + desc.out, 2)),
          dOutput(randomValues(yDesc.elements(), 3)),
          weightCount(std::uint32_t(desc.weightElements()))
    {
    }
    TensorId upload(RenderGraph& graph) const { return uploadTensor(graph, "x", xDesc, input); }
    LayerWeights uploadWeights(RenderGraph& graph) const
    {
        return {graph.uploadBuffer("weights", std::span(weights)), 0, weightCount};
    }
    ConvTwin twin() const
    {
        return {xDesc, yDesc, input, std::span(weights).first(weightCount),
                std::span(weights).subspan(weightCount)};
    }

    TensorDesc xDesc, yDesc;
    std::vector<float> input, weights, dOutput; // weights: then the bias
    std::uint32_t weightCount;
};

TensorId forward(RenderGraph& graph, const Conv2dDesc& d, const TensorId& x, const LayerWeights& w,
                 const TensorId& y)
{
    return conv2dForward(graph, "conv", d, x, w, y, Activation{ActivationKind::Relu});
}
TensorId forward(RenderGraph& graph, const ConvTranspose2dDesc& d, const TensorId& x,
                 const LayerWeights& w, const TensorId& y)
{
    return convTranspose2dForward(graph, "tconv", d, x, w, y, Activation{ActivationKind::Relu});
}
BufferId backwardWeight(RenderGraph& graph, const Conv2dDesc& d, const TensorId& x,
                        const TensorId& dY, const LayerWeights& gradient)
{
    return conv2dBackwardWeight(graph, "wgrad", d, x, dY, gradient);
}
BufferId backwardWeight(RenderGraph& graph, const ConvTranspose2dDesc& d, const TensorId& x,
                        const TensorId& dY, const LayerWeights& gradient)
{
    return convTranspose2dBackwardWeight(graph, "wgrad", d, x, dY, gradient);
}

// Compares scattered outputs of relu(conv(x) + bias).
template <class Desc>
double forwardError(const Desc& d, const ConvData& data, std::span<const float> y)
{
    std::vector<double> got, wanted;
    const std::uint64_t step = data.yDesc.elements() / kSamples | 1; // odd: visits all residues
    for (std::uint64_t i = 0; i < data.yDesc.elements(); i += step) {
        got.push_back(y[i]);
        wanted.push_back(std::max(data.twin().output(d, i), 0.0));
    }
    return normError(got, wanted);
}

template <class Desc> struct ForwardGraph
{
    ForwardGraph(Context& context, const Desc& desc, const ConvData& data)
        : graph(context), y(forward(graph, desc, data.upload(graph), data.uploadWeights(graph),
                                    createTensor(graph, "y", data.yDesc)))
    {
        graph.output(y.buffer);
    }
    RenderGraph graph;
    TensorId y;
};

template <class Desc>
KernelMeasurement measureForward(Context& context, const ConvCase<Desc>& c, const BenchOptions& o,
                                 Ceilings& ceilings)
{
    const ConvData data(c.desc, c.input(o.quick));
    ForwardGraph<Desc> conv(context, c.desc, data);
    KernelMeasurement m;
    m.flops = convFlops(c.desc, data.xDesc);
    m.bytes = double(data.xDesc.bytes() + data.yDesc.bytes() + data.weights.size() * 4);
    conv.graph.execute();
    m.error = forwardError(c.desc, data, conv.graph.template read<float>(conv.y.buffer));
    timeBeside(m, ceilings, conv.graph, {}, roundsOf(o));
    return m;
}

template <class Desc>
KernelMeasurement measureWeightGradient(Context& context, const ConvCase<Desc>& c,
                                        const BenchOptions& o, Ceilings& ceilings)
{
    const ConvData data(c.desc, c.input(o.quick));
    RenderGraph graph(context);
    const TensorId x = data.upload(graph);
    const TensorId dY = uploadTensor(graph, "dY", data.yDesc, data.dOutput);
    // The gradient accumulates: zero it, as a training step does.
    PassBuilder clear = graph.addTransferPass("clear");
    const BufferId zero =
        clear.write(graph.createBuffer("gradient", data.weights.size() * sizeof(float)));
    clear.fill(zero, 0);
    const BufferId gradient = backwardWeight(graph, c.desc, x, dY, {zero, 0, data.weightCount});
    graph.output(gradient);
    KernelMeasurement m;
    m.flops = convFlops(c.desc, data.xDesc);
    m.bytes = double(data.xDesc.bytes() + data.yDesc.bytes() + data.weights.size() * 4);
    graph.execute();
    const std::vector<float> values = graph.read<float>(gradient);
    std::vector<double> got, wanted;
    for (std::uint32_t s = 0; s < kWeightSamples; ++s) {
        const std::uint32_t i =
            std::uint32_t(s * (data.weightCount / kWeightSamples | 1)) % data.weightCount;
        got.push_back(values[i]);
        wanted.push_back(data.twin().weightGradient(c.desc, i, data.dOutput));
    }
    m.error = normError(got, wanted);
    // Random products nearly cancel: fp32 sums of 2e5 of them against their sum's size.
    m.tolerance = 5e-5;
    timeBeside(m, ceilings, graph, {}, roundsOf(o));
    return m;
}

// One invocation an output, storage buffers, bounds tested at every tap: what a first version looks
// like.
KernelMeasurement measureNaive(Context& context, const ConvCase<Conv2dDesc>& c,
                               const BenchOptions& o, Ceilings& ceilings)
{
    const ConvData data(c.desc, c.input(o.quick));
    RenderGraph graph(context);
    const TensorId x = data.upload(graph);
    const LayerWeights weights = data.uploadWeights(graph);
    const TensorId y = createTensor(graph, "y", data.yDesc);
    PassBuilder pass = graph.addComputePass("naive conv");
    pass.read(x.buffer);
    pass.read(weights.block);
    const BufferId to = pass.write(y.buffer);
    pass.dispatch(kernels::bench_conv_naive, {data.yDesc.w, data.yDesc.h, data.yDesc.c},
                  gpu::BenchConvPush{.inChannels = c.desc.in,
                                     .outChannels = c.desc.out,
                                     .height = data.xDesc.h,
                                     .width = data.xDesc.w,
                                     .kernel = c.desc.kernel.h,
                                     .padding = c.desc.padding.h},
                  {x.buffer, weights.block, to});
    graph.output(to);
    ForwardGraph<Conv2dDesc> engine(context, c.desc, data);
    KernelMeasurement m;
    m.flops = convFlops(c.desc, data.xDesc);
    graph.execute();
    m.error = forwardError(c.desc, data, graph.read<float>(to));
    const RoundTimings timings = timeBeside(m, ceilings, graph, {&engine.graph}, kNaiveRounds);
    m.more["engine_times_faster"] = timings.ratio(0, 1);
    return m;
}

} // namespace

void addConvBenchCases(std::vector<KernelCase>& cases)
{
    const ConvCase<Conv2dDesc> first{{.in = 24, .out = 32}, 640, 360};
    const ConvCase<Conv2dDesc> convs[] = {
        first,
        {{.in = 24, .out = 16}, 640, 360},
        {{.in = 24, .out = 16, .kernel = {2, 2}, .stride = {2, 2}, .padding = {0, 0}}, 640, 360},
        {{.in = 24, .out = 32, .kernel = {4, 4}, .stride = {2, 2}}, 640, 360},
        {{.in = 32, .out = 64, .stride = {2, 2}}, 320, 180},
        {{.in = 64, .out = 64}, 160, 90},
        {{.in = 24, .out = 3}, 640, 360}};
    const ConvCase<ConvTranspose2dDesc> transposed[] = {
        {{.in = 64, .out = 32, .kernel = {4, 4}, .padding = {1, 1}}, 160, 90},
        {{.in = 32, .out = 16, .kernel = {4, 4}, .padding = {1, 1}}, 320, 180},
        {{.in = 64, .out = 32}, 160, 90}};
    const auto add = [&](const std::string& name, const auto& c, auto measure) {
        cases.push_back(
            {name + nameOf(c), [=](Context& context, const BenchOptions& o, Ceilings& ceilings) {
                 return measure(context, c, o, ceilings);
             }});
    };
    for (const auto& c : convs)
        add("conv ", c, measureForward<Conv2dDesc>);
    add("naive conv ", first, measureNaive);
    for (const auto& c : transposed)
        add("transposed conv ", c, measureForward<ConvTranspose2dDesc>);
    for (const auto& c : {convs[0], convs[4], convs[5]})
        add("weight gradient ", c, measureWeightGradient<Conv2dDesc>);
    add("weight gradient transposed ", transposed[0], measureWeightGradient<ConvTranspose2dDesc>);
}

} // namespace strandlight::cli
