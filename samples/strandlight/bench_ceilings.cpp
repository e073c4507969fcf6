// The ceilings of the device, measured by kernels that do nothing else.
#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/bench.gen.hpp"
#include "samples/strandlight/bench_kernels.hpp"
#include "shaders/shared/bench_types.h"
#include "shaders/shared/rng.h"

namespace strandlight::cli {

namespace {

Ceiling measureMultiplyAdd(Context& context, const BenchOptions& o)
{
    // One workgroup's worth of work is long against its start; enough groups to fill any device.
    const std::uint32_t threads = o.quick ? 1024 : 16384;
    const gpu::BenchLoopPush push{.turns = o.quick ? 32u : 128u, .factor = 0.5f, .addend = 1.0f};
    Ceiling ceiling;
    ceiling.graph = std::make_unique<RenderGraph>(context);
    RenderGraph& graph = *ceiling.graph;
    PassBuilder pass = graph.addComputePass("multiply-add");
    const BufferId result = pass.write(graph.createBuffer("result", threads * 4));
    pass.dispatch(kernels::bench_madd, {threads, 1, 1}, push, {result});
    graph.output(result);

    KernelMeasurement& m = ceiling.found;
    m.timing = timeGraph(graph, roundsOf(o));
    m.flops = 2.0 * threads * push.turns * gpu::kBenchUnroll * gpu::kBenchChains;
    const std::vector<float> values = graph.read<float>(result);
    std::vector<double> got, wanted;
    for (std::uint32_t id = 0; id < threads; id += 97) {
        const double factor = double(push.factor) + (id & 7u) * 1e-6;
        double sum = 0.0;
        for (std::uint32_t k = 0; k < gpu::kBenchChains; ++k) {
            double chain = k;
            for (std::uint32_t step = 0; step < push.turns * gpu::kBenchUnroll; ++step)
                chain = chain * factor + double(push.addend);
            sum += chain;
        }
        got.push_back(values[id]);
        wanted.push_back(sum);
    }
    m.error = normError(got, wanted);
    return ceiling;
}

Ceiling measureExponential(Context& context, const BenchOptions& o)
{
    const std::uint32_t threads = o.quick ? 1024 : 16384;
    const gpu::BenchLoopPush push{.turns = o.quick ? 16u : 64u, .factor = -0.1f, .addend = 0.0f};
    Ceiling ceiling;
    ceiling.graph = std::make_unique<RenderGraph>(context);
    RenderGraph& graph = *ceiling.graph;
    PassBuilder pass = graph.addComputePass("exp");
    const BufferId result = pass.write(graph.createBuffer("result", threads * 4));
    pass.dispatch(kernels::bench_exp, {threads, 1, 1}, push, {result});
    graph.output(result);

    KernelMeasurement& m = ceiling.found;
    m.timing = timeGraph(graph, roundsOf(o));
    m.flops = double(threads) * push.turns * gpu::kBenchExpUnroll * gpu::kBenchExpChains;
    const std::vector<float> values = graph.read<float>(result);
    std::vector<double> got, wanted;
    for (std::uint32_t id = 0; id < threads; id += 97) {
        double sum = 0.0;
        for (std::uint32_t k = 0; k < gpu::kBenchExpChains; ++k) {
            double chain = double(push.factor) * (k + 1) - (id & 7u);
            for (std::uint32_t step = 0; step < push.turns * gpu::kBenchExpUnroll; ++step)
                chain = -std::exp2(chain);
            sum += chain;
        }
        got.push_back(values[id]);
        wanted.push_back(sum);
    }
    m.error = normError(got, wanted);
    return ceiling;
}

Ceiling measureTriad(Context& context, const BenchOptions& o)
{
    // Three buffers of 128 MiB, the most that one binding takes: larger than any cache.
    const std::uint32_t count = o.quick ? 1u << 20 : 1u << 25;
    const float factor = 3.0f;
    std::vector<float> left(count), right(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        left[i] = float(i % 1021);
        right[i] = float(i % 257) * 0.25f;
    }
    Ceiling ceiling;
    for (const char* name : {"triad a", "triad b", "triad c"})
        ceiling.buffers.push_back(std::make_unique<Buffer>(context, count * 4ull, name));
    Buffer &a = *ceiling.buffers[0], &b = *ceiling.buffers[1], &c = *ceiling.buffers[2];
    b.upload(std::as_bytes(std::span(left)));
    c.upload(std::as_bytes(std::span(right)));
    ceiling.graph = std::make_unique<RenderGraph>(context);
    RenderGraph& graph = *ceiling.graph;
    const BufferId bId = graph.importBuffer(b), cId = graph.importBuffer(c);
    PassBuilder pass = graph.addComputePass("triad");
    pass.read(bId);
    pass.read(cId);
    const BufferId result = pass.write(graph.importBuffer(a));
    pass.dispatch(kernels::bench_triad, {count / 4, 1, 1}, gpu::BenchTriadPush{factor},
                  {bId, cId, result});

    KernelMeasurement& m = ceiling.found;
    m.timing = timeGraph(graph, roundsOf(o));
    m.bytes = 12.0 * count;
    const std::vector<float> values = a.downloadAs<float>();
    std::vector<double> got, wanted;
    for (std::uint32_t i = 0; i < count; i += 1009) {
        got.push_back(values[i]);
        wanted.push_back(left[i] + double(factor) * right[i]);
    }
    m.error = normError(got, wanted);
    return ceiling;
}

} // namespace

std::vector<float> randomValues(std::size_t count, std::uint32_t seed)
{
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = 2.0f * gpu::uniform3(std::uint32_t(i), 0, 0, seed).x - 1.0f;
    return values;
}

double normError(const std::vector<double>& got, const std::vector<double>& wanted)
{
    double difference = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        difference += (got[i] - wanted[i]) * (got[i] - wanted[i]);
        norm += wanted[i] * wanted[i];
    }
    return std::sqrt(difference) / std::max(std::sqrt(norm), 1e-30);
}

Ceilings measureCeilings(Context& context, const BenchOptions& options)
{
    Ceilings ceilings{measureMultiplyAdd(context, options), measureExponential(context, options),
                      measureTriad(context, options)};
    requireCheck("ceiling multiply-add", ceilings.multiplyAdd.found);
    requireCheck("ceiling exp", ceilings.exponential.found);
    requireCheck("ceiling triad", ceilings.triad.found);
    KernelMeasurement& exponential = ceilings.exponential.found;
    timeBeside(exponential, ceilings, *ceilings.exponential.graph, {}, roundsOf(options));
    ceilings.flopsOfExp = 1.0 / exponential.ofMultiplyAdd;
    return ceilings;
}

} // namespace strandlight::cli
