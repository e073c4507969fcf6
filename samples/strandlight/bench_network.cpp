// Whole networks of `strandlight bench kernels`: forward pass and training step.
#include <cstdio>
#include <optional>

#include "compute_nn/reference/networks.hpp"
#include "compute_nn/training_memory.hpp"
#include "compute_nn/unet.hpp"
#include "engine/graph/plan.hpp"
#include "samples/strandlight/bench_conv_twin.hpp"
#include "samples/strandlight/bench_kernels.hpp"

namespace strandlight::cli {

namespace {

constexpr std::uint32_t kSeed = 1;

struct NetworkCase
{
    std::string name;
    UNetDesc net;
    TensorDesc input; // [1,in,H,W]
};

// Multiply-adds of the convolutions alone, twice.
double forwardFlops(const UNetDesc& net, const TensorDesc& x)
{
    double flops = convFlops(net.last(), net.level(0, x));
    for (std::uint32_t l = net.head > 0 ? 0 : 1; l <= net.levels(); ++l) {
        TensorDesc from = l == 0 ? x : net.level(l - 1, x);
        from.c = net.encoder(l).in;
        flops += convFlops(net.encoder(l), from);
    }
    for (std::uint32_t l = 0; l < net.levels(); ++l)
        flops += convFlops(net.decoder(l), net.level(l + 1, x));
    return flops;
}

TensorDesc outputOf(const NetworkCase& c, const TensorDesc& x)
{
    return {x.n, c.net.out, x.h, x.w};
}

// The answer to x; with `guard` activations are stored as halves.
BufferId addForward(RenderGraph& graph, const NetworkCase& c, Parameters& parameters,
                    const TensorDesc& x, const std::vector<float>& values, HalfGuard* guard)
{
    const ParameterIds ids(graph, parameters);
    const TensorId input = uploadTensor(graph, "x", x, values);
    const BufferId y = unetForward(graph, c.net, ids, input, nullptr, guard).y.buffer;
    graph.output(y);
    if (guard)
        guard->output(graph);
    return y;
}

// Forward pass of a small image against the whole twin; the kernels are those of the large one.
double forwardError(Context& context, const NetworkCase& c, Parameters& parameters, bool halves)
{
    const std::uint32_t side = 1u << c.net.levels();
    const TensorDesc small{1, c.net.in, 3 * side, 5 * side};
    const std::vector<float> x = randomValues(small.elements(), 4);
    RenderGraph graph(context);
    std::optional<HalfGuard> guard;
    if (halves)
        guard.emplace(graph);
    const BufferId answer = addForward(graph, c, parameters, small, x, guard ? &*guard : nullptr);
    graph.execute();
    if (guard)
        guard->check(graph);
    const std::vector<float> y = graph.read<float>(answer), w = parameters.download();
    const std::vector<double> target(outputOf(c, small).elements(), 0.0),
        weights(w.begin(), w.end()), input(x.begin(), x.end());
    const auto twin = reference::unet<double>(c.net, weights, small, input, target);
    return normError({y.begin(), y.end()}, twin.output);
}

struct ForwardGraph
{
    ForwardGraph(Context& context, const NetworkCase& c, Parameters& parameters,
                 const TensorDesc& x, bool halves)
        : graph(context)
    {
        if (halves)
            guard.emplace(graph);
        addForward(graph, c, parameters, x, randomValues(x.elements(), 5),
                   guard ? &*guard : nullptr);
    }
    RenderGraph graph;
    std::optional<HalfGuard> guard;
};

void addStep(RenderGraph& graph, const NetworkCase& c, Parameters& parameters, const TensorDesc& x)
{
    ParameterIds ids(graph, parameters);
    const TensorDesc y = outputOf(c, x);
    const TensorId input = uploadTensor(graph, "x", x, randomValues(x.elements(), 5));
    const TensorId target = uploadTensor(graph, "target", y, randomValues(y.elements(), 6));
    addUNetTrainingStep(graph, c.net, ids, input, target, {}, 1);
}

TensorDesc inputOf(const NetworkCase& c, bool quick)
{
    TensorDesc x = c.input;
    if (quick)
        x.h = x.w = 8u << c.net.levels();
    return x;
}

KernelMeasurement measureForward(Context& context, const NetworkCase& c, const BenchOptions& o,
                                 Ceilings& ceilings)
{
    Parameters parameters(context, c.net.parameters(), kSeed);
    const TensorDesc x = inputOf(c, o.quick);
    ForwardGraph forward(context, c, parameters, x, false);
    KernelMeasurement m;
    m.error = forwardError(context, c, parameters, false);
    m.flops = forwardFlops(c.net, x);
    timeBeside(m, ceilings, forward.graph, {}, roundsOf(o));
    return m;
}

// Activations as halves: one rounding of 2^-11 a stored value, so an error of that size.
KernelMeasurement measureHalves(Context& context, const NetworkCase& c, const BenchOptions& o,
                                Ceilings& ceilings)
{
    Parameters parameters(context, c.net.parameters(), kSeed);
    const TensorDesc x = inputOf(c, o.quick);
    ForwardGraph halves(context, c, parameters, x, true), floats(context, c, parameters, x, false);
    KernelMeasurement m;
    m.error = forwardError(context, c, parameters, true);
    m.tolerance = 0x1p-10 * (2.0 * c.net.levels() + 1.0);
    m.flops = forwardFlops(c.net, x);
    const RoundTimings timings =
        timeBeside(m, ceilings, halves.graph, {&floats.graph}, roundsOf(o));
    m.more["over_fp32"] = timings.ratio(0, 1);
    return m;
}

// The gradients of this step are what tests/nn/test_training.cpp traces; here its forward part is
// checked. The forward pass beside it has parameters of its own, which stay as they are.
KernelMeasurement measureStep(Context& context, const NetworkCase& c, const BenchOptions& o,
                              Ceilings& ceilings)
{
    Parameters trained(context, c.net.parameters(), kSeed),
        parameters(context, c.net.parameters(), kSeed);
    const TensorDesc x = inputOf(c, o.quick);
    RenderGraph step(context);
    addStep(step, c, trained, x);
    ForwardGraph forward(context, c, parameters, x, false);
    KernelMeasurement m;
    m.error = forwardError(context, c, parameters, false);
    // Backward: a data and a weight gradient of each layer, but no data gradient of the first.
    m.flops = 3.0 * forwardFlops(c.net, x) - convFlops(c.net.encoder(c.net.head > 0 ? 0 : 1), x);
    const RoundTimings timings = timeBeside(m, ceilings, step, {&forward.graph}, roundsOf(o));
    m.more["over_forward"] = timings.ratio(0, 1);
    return m;
}

std::vector<NetworkCase> networks()
{
    return {{"U-Net 24-16-32-64-64-3 640x384", benchmarkUNet(), {1, 24, 384, 640}},
            {"hair U-Net 640x384", hairUNet(), {1, hairUNet().in, 384, 640}}};
}

} // namespace

void addNetworkBenchCases(std::vector<KernelCase>& cases, bool halves)
{
    for (const NetworkCase& network : networks()) {
        const auto add = [&](const std::string& what, auto measure) {
            cases.push_back({network.name + what,
                             [=](Context& context, const BenchOptions& o, Ceilings& ceilings) {
                                 return measure(context, network, o, ceilings);
                             }});
        };
        add(" forward", measureForward);
        if (halves)
            add(" forward, fp16 storage", measureHalves);
        add(" training step", measureStep);
    }
}

void printMemoryPlans(Context& context)
{
    for (const NetworkCase& c : networks()) {
        Parameters parameters(context, c.net.parameters(), kSeed);
        RenderGraph graph(context);
        addStep(graph, c, parameters, c.input);
        std::printf("%s, one training step\n", c.name.c_str());
        std::printf("%s", planTrainingMemory(parameters.layout(), graph.compile()).text.c_str());
    }
}

} // namespace strandlight::cli
