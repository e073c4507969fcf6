// strandlight bench skip: time and memory of scenes that lack something, over one that has all.
#include <memory>

#include "engine/base/error.hpp"
#include "passes/skip_study.hpp"
#include "samples/strandlight/bench.hpp"

namespace strandlight::cli {

namespace {

Json rowJson(const SkipRow& row, const SkipRow& full)
{
    return {{"name", row.name},
            {"study", "skip"},
            {"passes", row.passes.size()},
            {"skipped", row.skipped},
            {"pipelines", row.pipelines},
            {"capture_dispatches", row.captureDispatches},
            {"lobes", row.lobes},
            {"environment_lobes", row.environmentLobes},
            {"bake_s", row.bakeSeconds},
            {"bake_over_full", row.bakeSeconds / full.bakeSeconds},
            {"frame_ms", row.frameMilliseconds},
            {"frame_over_full", row.frameMilliseconds / full.frameMilliseconds},
            {"peak_mib", double(row.peakBytes) / (1 << 20)},
            {"memory_over_full", double(row.peakBytes) / double(full.peakBytes)}};
}

int benchSkip(const BenchOptions& options)
{
    BenchReport report("bench skip", options, openDevice(options.device));
    SkipSettings settings;
    if (!options.quick)
        settings = {.atlas = 64,
                    .samples = 8,
                    .steps = 600,
                    .width = 320,
                    .height = 240,
                    .strands = 8000,
                    .repeats = 3};
    const std::vector<SkipRow> rows = studySkips({.device = options.device.device}, settings);
    for (const SkipRow& row : rows) {
        if (!row.wrong.empty())
            throw Error("bench skip: " + row.name + " ran '" + row.wrong.front() +
                        "', which it does not need");
        report.add(rowJson(row, rows.front()));
    }
    report.finish();
    return 0;
}

} // namespace

Command addBenchSkip(CLI::App& bench)
{
    CLI::App* app = bench.add_subcommand(
        "skip", "Scenes without environment, hair, metal, light or anything, over a full one");
    const auto o = std::make_shared<BenchOptions>();
    addBenchOptions(*app, *o);
    addExamples(*app, "  strandlight bench skip --json skip.json");
    return {app, [o] { return benchSkip(*o); }};
}

} // namespace strandlight::cli
