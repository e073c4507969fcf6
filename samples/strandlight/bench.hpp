// strandlight bench: what its subcommands share. A benchmark is a list of rows, one measurement
// each, printed as a table and written as JSON and CSV; a row comes after its check has passed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/base/image.hpp"
#include "engine/graph/render_graph.hpp"
#include "samples/strandlight/options.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

struct BenchOptions
{
    DeviceOptions device;
    std::string json;
    std::string csv;
    std::string filter; // part of a row's name; "": all
    bool quick = false; // smaller cases, fewer runs: shows that it works, not how fast
};
void addBenchOptions(CLI::App& app, BenchOptions& options);

// Milliseconds of a number of runs after a warm-up.
struct Timing
{
    double median = 0.0;
    double minimum = 0.0;
    std::uint32_t runs = 0;
};
Timing timingOf(std::vector<double> milliseconds); // throws Error when empty
// Graphs that run in turns, each once a round, so that a ratio compares neighbours in time: the
// clock of a shared machine wanders by half within one benchmark.
class RoundTimings
{
public:
    // Every graph once to warm up (lavapipe compiles at the first dispatch), then `rounds` times,
    // as a whole by the device's clock. Throws Interrupted between runs.
    RoundTimings(std::span<RenderGraph* const> graphs, std::uint32_t rounds);
    Timing of(std::size_t graph) const { return timingOf(milliseconds_[graph]); }
    // Median over the rounds of the time of `a` over that of `b`.
    double ratio(std::size_t a, std::size_t b) const;

private:
    std::vector<std::vector<double>> milliseconds_; // [graph][round]
};
Timing timeGraph(RenderGraph& graph, std::uint32_t runs); // alone
// Medians by pass, in order, of another so many runs.
std::vector<PassTiming> timePasses(RenderGraph& graph, std::uint32_t runs);

std::string rowsText(const Json& rows); // as a table, columns as below

// STEM.png, STEM_truth.png and STEM_flip.png in the folder, of linear pictures; what a report says
// of them ("pictures" of a benchmark's JSON).
Json savePictureSet(const std::filesystem::path& folder, const std::string& stem,
                    const std::string& title, const std::string& caption, const CpuImage& ours,
                    const CpuImage& truth);

// Rows are flat JSON objects; columns are their keys in the order of first appearance.
class BenchReport
{
public:
    // `command`: "bench kernels". Throws FileError when an output cannot be written.
    BenchReport(const std::string& command, const BenchOptions& options, const Context& context);

    bool wants(const std::string& name) const; // does --filter let this row through?
    Json& about() { return about_; }           // what the JSON says beside the rows
    void add(Json row) { rows_.push_back(std::move(row)); }
    void setRows(Json rows) { rows_ = std::move(rows); } // instead of those before
    const Json& rows() const { return rows_; }
    void finish() const; // prints the table and writes; throws Error without rows
    void write() const;  // --json and --csv

private:
    BenchOptions options_;
    Json about_;
    Json rows_ = Json::array();
};

// Subcommands, one source file each.
Command addBenchKernels(CLI::App& bench);
Command addBenchHairFilter(CLI::App& bench);
Command addBenchGi(CLI::App& bench);
Command addBenchAll(CLI::App& bench);
Command addBenchPage(CLI::App& bench);
Command addBenchHair(CLI::App& bench);
Command addBenchSkip(CLI::App& bench);

// What they run; the result is the exit code.
int benchKernels(const BenchOptions& options);

} // namespace strandlight::cli
