// strandlight bench kernels: network kernels checked, timed and held against the device's ceilings.
#include "samples/strandlight/bench_kernels.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"

namespace strandlight::cli {

namespace {

constexpr std::uint32_t kRounds = 15;

Json describe(const std::string& name, const KernelMeasurement& m)
{
    Json row = {{"name", name},
                {"error", m.error},
                {"ms_median", m.timing.median},
                {"ms_minimum", m.timing.minimum},
                {"runs", m.timing.runs}};
    if (m.flops > 0.0)
        row["gflops"] = m.flops / m.timing.median * 1e-6;
    if (m.ofMultiplyAdd > 0.0)
        row["of_multiply_add"] = m.ofMultiplyAdd;
    if (m.bytes > 0.0)
        row["gb_per_s"] = m.bytes / m.timing.median * 1e-6;
    if (m.ofTriad > 0.0)
        row["of_triad"] = m.ofTriad;
    row.update(m.more);
    return row;
}

std::vector<KernelCase> allCases(const Context& context)
{
    std::vector<KernelCase> cases;
    addConvBenchCases(cases);
    addNetworkBenchCases(cases, context.device().missingForHalves.empty());
    addSgBenchCases(cases);
    addReductionBenchCases(cases);
    addFirstRunBenchCases(cases);
    return cases;
}

} // namespace

std::uint32_t roundsOf(const BenchOptions& options)
{
    return options.quick ? 2 : kRounds;
}

RoundTimings timeBeside(KernelMeasurement& m, Ceilings& ceilings, RenderGraph& graph,
                        std::vector<RenderGraph*> others, std::uint32_t rounds)
{
    const bool arithmetic = m.flops > 0.0;
    const Ceiling& ceiling = arithmetic ? ceilings.multiplyAdd : ceilings.triad;
    others.insert(others.begin(), &graph);
    others.push_back(ceiling.graph.get());
    RoundTimings timings(others, rounds);
    m.timing = timings.of(0);
    const double work = arithmetic ? m.flops / ceiling.found.flops : m.bytes / ceiling.found.bytes;
    (arithmetic ? m.ofMultiplyAdd : m.ofTriad) = work / timings.ratio(0, others.size() - 1);
    return timings;
}

int benchKernels(const BenchOptions& o)
{
    Context context = openDevice(o.device);
    BenchReport report("bench kernels", o, context);
    const std::vector<KernelCase> cases = allCases(context);
    if (std::none_of(cases.begin(), cases.end(),
                     [&](const KernelCase& c) { return report.wants(c.name); }))
        throw Error("--filter: no case's name holds '" + o.filter + "'");
    Ceilings ceilings = measureCeilings(context, o);
    report.about()["ceilings"] = {
        {"multiply_add_gflops", ceilings.gflops()},
        {"multiply_add", "chains of a*b+c in registers, best run"},
        {"of_multiply_add", "median over rounds in which a case and the multiply-adds take turns"},
        {"gflops",
         "operations of the plain sum, whatever a kernel takes for it: on CPU devices 3x3 of "
         "stride 1 takes half the products, its weight gradient a third"},
        {"exp_flops", ceilings.flopsOfExp},
        {"exp", "multiply-adds' flops in the time of one exponential of the network kernels"},
        {"triad_gb_per_s", ceilings.gigabytes()},
        {"triad", "a = b + s c from memory, 12 bytes an element, best run"},
        {"of_triad", "as of_multiply_add, where no flops are counted"}};
    if (o.quick)
        std::printf("quick: images of a quarter of the size named, few rounds\n");
    report.add(describe("ceiling multiply-add", ceilings.multiplyAdd.found));
    report.add(describe("ceiling triad", ceilings.triad.found));
    Progress progress("bench kernels", cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        throwIfInterrupted();
        progress.update(i);
        if (!report.wants(cases[i].name))
            continue;
        const KernelMeasurement m = cases[i].measure(context, o, ceilings);
        requireCheck(cases[i].name, m);
        report.add(describe(cases[i].name, m));
    }
    progress.update(cases.size());
    report.finish();
    return 0;
}

void requireCheck(const std::string& name, const KernelMeasurement& m)
{
    if (m.error <= m.tolerance) // false for NaN
        return;
    char reason[96];
    std::snprintf(reason, sizeof reason, ": error %.2e against the CPU twin, at most %.0e", m.error,
                  m.tolerance);
    throw Error(name + reason);
}

Command addBenchKernels(CLI::App& bench)
{
    CLI::App* app = bench.add_subcommand(
        "kernels", "Network kernels against their CPU twins and the device's ceilings");
    const auto o = std::make_shared<BenchOptions>();
    const auto memory = std::make_shared<bool>(false);
    addBenchOptions(*app, *o);
    app->add_flag("--memory", *memory,
                  "Only print what the networks' training steps will allocate");
    addExamples(*app, "  strandlight bench kernels --json kernels.json --csv kernels.csv\n"
                      "  strandlight bench kernels --filter conv\n"
                      "  strandlight bench kernels --memory");
    return {app, [o, memory] {
                if (!*memory)
                    return benchKernels(*o);
                Context context = openDevice(o->device);
                printMemoryPlans(context);
                return 0;
            }};
}

} // namespace strandlight::cli
