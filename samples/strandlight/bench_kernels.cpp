// strandlight bench kernels: network kernels checked, timed and held against the device's ceilings.
#include "samples/strandlight/bench_kernels.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"

namespace strandlight::cli {

namespace {

Json describe(const std::string& name, const KernelMeasurement& m, const Ceilings& ceilings)
{
    Json row = {{"name", name},
                {"error", m.error},
                {"ms_median", m.timing.median},
                {"ms_minimum", m.timing.minimum},
                {"runs", m.timing.runs}};
    if (m.flops > 0.0) {
        const double gflops = m.flops / m.timing.median * 1e-6;
        row["gflops"] = gflops;
        row["of_multiply_add"] = gflops / ceilings.gflops();
    }
    if (m.bytes > 0.0) {
        const double gigabytes = m.bytes / m.timing.median * 1e-6;
        row["gb_per_s"] = gigabytes;
        row["of_triad"] = gigabytes / ceilings.gigabytes();
    }
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

int benchKernels(const BenchOptions& o)
{
    Context context = openDevice(o.device);
    BenchReport report("bench kernels", o, context);
    const std::vector<KernelCase> cases = allCases(context);
    if (std::none_of(cases.begin(), cases.end(),
                     [&](const KernelCase& c) { return report.wants(c.name); }))
        throw Error("--filter: no case's name holds '" + o.filter + "'");
    const Ceilings ceilings = measureCeilings(context, o);
    report.about()["ceilings"] = {
        {"multiply_add_gflops", ceilings.gflops()},
        {"multiply_add", "chains of a*b+c in registers, best run; of_multiply_add is over this"},
        {"exp_flops", ceilings.flopsOfExp()},
        {"exp", "multiply-adds' flops in the time of one exponential of the network kernels"},
        {"triad_gb_per_s", ceilings.gigabytes()},
        {"triad", "a = b + s c from memory, 12 bytes an element, best run; of_triad is over this"}};
    if (o.quick)
        std::printf("quick: images of a quarter of the size named, two runs each\n");
    report.add(describe("ceiling multiply-add", ceilings.multiplyAdd, ceilings));
    report.add(describe("ceiling triad", ceilings.triad, ceilings));
    Progress progress("bench kernels", cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        throwIfInterrupted();
        progress.update(i);
        if (!report.wants(cases[i].name))
            continue;
        const KernelMeasurement m = cases[i].measure(context, o, ceilings);
        requireCheck(cases[i].name, m);
        report.add(describe(cases[i].name, m, ceilings));
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
