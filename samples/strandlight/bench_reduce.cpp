// Sums, losses and the optimiser of `strandlight bench kernels`: bound by memory.
#include <algorithm>
#include <cmath>

#include "compute_nn/adam.hpp"
#include "compute_nn/loss.hpp"
#include "compute_nn/reference/adam.hpp"
#include "compute_nn/reference/loss.hpp"
#include "compute_nn/reference/sum.hpp"
#include "compute_nn/sum.hpp"
#include "samples/strandlight/bench_kernels.hpp"

namespace strandlight::cli {

namespace {

// Series that plain summation gets wrong in one way or another.
std::vector<std::vector<float>> stressSeries(std::uint32_t count)
{
    std::vector<float> ones(count, 1.0f), alternating(count), spread = randomValues(count, 10);
    for (std::uint32_t i = 0; i < count; ++i) {
        alternating[i] = i % 2 ? -1e4f : 1e4f;
        spread[i] = std::exp(6.0f * spread[i]); // e^U(-6,6)
    }
    std::vector<float> sorted = spread;
    std::sort(sorted.begin(), sorted.end());
    return {std::move(ones), std::move(alternating), std::move(spread), std::move(sorted)};
}

// Error relative to the sum of magnitudes, the largest of all series; the time of the last.
KernelMeasurement measureSum(Context& context, const BenchOptions& o, Ceilings& ceilings)
{
    const std::uint32_t count = o.quick ? 100'000 : 10'000'000;
    KernelMeasurement m;
    m.tolerance = 1e-6;
    m.bytes = 4.0 * count;
    for (const std::vector<float>& values : stressSeries(count)) {
        RenderGraph graph(context);
        const BufferId sum =
            addSumPass(graph, "sum", graph.uploadBuffer("values", std::span(values)), count);
        graph.output(sum);
        timeBeside(m, ceilings, graph, {}, roundsOf(o));
        const std::vector<double> exact(values.begin(), values.end());
        double magnitudes = 0.0;
        for (const double v : exact)
            magnitudes += std::abs(v);
        const double error = graph.read<float>(sum)[0] - reference::sum<double>(exact);
        m.error = std::max(m.error, std::abs(error) / magnitudes);
    }
    return m;
}

KernelMeasurement measureLoss(Context& context, const BenchOptions& o, Ceilings& ceilings)
{
    const TensorDesc desc{1, 3, o.quick ? 96u : 384u, o.quick ? 160u : 640u};
    std::vector<float> prediction = randomValues(desc.elements(), 11);
    std::vector<float> target = randomValues(desc.elements(), 12);
    for (std::vector<float>* values : {&prediction, &target})
        for (float& v : *values)
            v = v + 1.0f; // radiance is not negative
    RenderGraph graph(context);
    const LossResult loss = addLossPass(graph, "loss", LossKind::Log1p,
                                        uploadTensor(graph, "prediction", desc, prediction),
                                        uploadTensor(graph, "target", desc, target));
    graph.output(loss.value);
    graph.output(loss.gradient.buffer);
    KernelMeasurement m;
    m.bytes = 3.0 * double(desc.bytes());
    timeBeside(m, ceilings, graph, {}, roundsOf(o));
    std::vector<double> gradient(desc.elements(), 0.0);
    const std::vector<double> p(prediction.begin(), prediction.end()),
        t(target.begin(), target.end());
    const double value = reference::loss<double>(LossKind::Log1p, p, t, {}, 1, gradient);
    const std::vector<float> got = graph.read<float>(loss.gradient.buffer);
    m.error = std::max(normError({got.begin(), got.end()}, gradient),
                       std::abs(graph.read<float>(loss.value)[0] / value - 1.0));
    return m;
}

// The same first step again and again, here and in the twin.
KernelMeasurement measureAdam(Context& context, const BenchOptions& o, Ceilings& ceilings)
{
    const std::uint32_t count = o.quick ? 1u << 14 : 1u << 20, rounds = roundsOf(o);
    ParameterLayout layout;
    layout.add("all", {count}, 100);
    Parameters parameters(context, layout, 1);
    const std::vector<float> start = parameters.download(), gradient = randomValues(count, 13);
    RenderGraph graph(context);
    ParameterIds ids(graph, parameters);
    const BufferId from = graph.uploadBuffer("given gradient", std::span(gradient));
    PassBuilder copy = graph.addTransferPass("gradient");
    copy.read(from);
    ids.gradient = copy.write(ids.gradient);
    copy.copy(from, ids.gradient, count * 4ull);
    const AdamSettings settings;
    addAdamPass(graph, ids, settings, 1);
    KernelMeasurement m;
    m.bytes = 10.0 * count * 4.0; // copied, checked, read; parameters and moments read and written
    timeBeside(m, ceilings, graph, {}, rounds);
    std::vector<double> wanted(start.begin(), start.end()), moment1(count, 0.0),
        moment2(count, 0.0);
    const std::vector<double> g(gradient.begin(), gradient.end());
    for (std::uint32_t i = 0; i < 1 + rounds; ++i)
        reference::adamStep<double>(settings, 1, g, wanted, moment1, moment2);
    const std::vector<float> got = parameters.download();
    m.error = normError({got.begin(), got.end()}, wanted);
    return m;
}

} // namespace

void addReductionBenchCases(std::vector<KernelCase>& cases)
{
    cases.push_back({"sum of 1e7 floats, worst of four series", measureSum});
    cases.push_back({"loss log1p 3x640x384", measureLoss});
    cases.push_back({"Adam 2^20 parameters", measureAdam});
}

} // namespace strandlight::cli
