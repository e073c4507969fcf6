// Rows of a benchmark as a table, JSON and CSV; timing of graphs.
#include <algorithm>
#include <cstdio>
#include <ctime>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/flip.hpp"
#include "engine/base/image_io.hpp"
#include "engine/base/image_metrics.hpp"
#include "engine/base/progress.hpp"
#include "samples/strandlight/bench.hpp"

namespace strandlight::cli {

namespace {

std::vector<std::string> columnsOf(const Json& rows)
{
    std::vector<std::string> columns;
    for (const Json& row : rows)
        for (const auto& [key, value] : row.items())
            if (std::find(columns.begin(), columns.end(), key) == columns.end())
                columns.push_back(key);
    return columns;
}

// "" where the row has no such value; four digits, which is more than a timing repeats.
std::string cellText(const Json& row, const std::string& column)
{
    const auto value = row.find(column);
    if (value == row.end() || value->is_null())
        return "";
    if (value->is_string())
        return value->get<std::string>();
    if (!value->is_number_float())
        return value->dump();
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value->get<double>());
    return text;
}

// RFC 4180: quotes around what holds a comma, a quote or a line end.
std::string csvCell(const Json& row, const std::string& column)
{
    const auto value = row.find(column);
    if (value == row.end() || value->is_null())
        return "";
    const std::string text = value->is_string() ? value->get<std::string>() : value->dump();
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (const char c : text)
        quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string csvOf(const Json& rows)
{
    const std::vector<std::string> columns = columnsOf(rows);
    std::string text;
    for (std::size_t i = 0; i < columns.size(); ++i)
        text += (i ? "," : "") + columns[i];
    for (const Json& row : rows) {
        text += '\n';
        for (std::size_t i = 0; i < columns.size(); ++i)
            text += (i ? "," : "") + csvCell(row, columns[i]);
    }
    return text + '\n';
}

std::string utcNow()
{
    const std::time_t now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", std::gmtime(&now));
    return text;
}

} // namespace

void addBenchOptions(CLI::App& app, BenchOptions& options)
{
    app.add_option("--filter", options.filter, "Only rows whose name holds this")
        ->type_name("NAME");
    app.add_flag("--quick", options.quick, "Small cases, few runs: a trial, not a measurement");
    addJsonOption(app, options.json);
    app.add_option("--csv", options.csv, "The rows alone")->type_name("FILE");
    addDeviceOptions(app, options.device);
}

Timing timingOf(std::vector<double> milliseconds)
{
    if (milliseconds.empty())
        throw Error("bench: no run was timed");
    std::sort(milliseconds.begin(), milliseconds.end());
    const std::size_t half = milliseconds.size() / 2;
    const double median = milliseconds.size() % 2 != 0
                              ? milliseconds[half]
                              : 0.5 * (milliseconds[half - 1] + milliseconds[half]);
    return {median, milliseconds.front(), std::uint32_t(milliseconds.size())};
}

RoundTimings::RoundTimings(std::span<RenderGraph* const> graphs, std::uint32_t rounds)
    : milliseconds_(graphs.size())
{
    for (RenderGraph* graph : graphs) {
        graph->setTimings(Timings::Whole);
        graph->execute();
    }
    for (std::uint32_t i = 0; i < rounds; ++i)
        for (std::size_t g = 0; g < graphs.size(); ++g) {
            throwIfInterrupted();
            graphs[g]->execute();
            milliseconds_[g].push_back(graphs[g]->timings().front().milliseconds);
        }
}

double RoundTimings::ratio(std::size_t a, std::size_t b) const
{
    std::vector<double> ratios;
    for (std::size_t i = 0; i < milliseconds_[a].size(); ++i)
        ratios.push_back(milliseconds_[a][i] / milliseconds_[b][i]);
    return timingOf(std::move(ratios)).median;
}

Timing timeGraph(RenderGraph& graph, std::uint32_t runs)
{
    RenderGraph* const alone = &graph;
    return RoundTimings({&alone, 1}, runs).of(0);
}

std::vector<PassTiming> timePasses(RenderGraph& graph, std::uint32_t runs)
{
    graph.setTimings(Timings::Passes);
    std::vector<PassTiming> passes;
    std::vector<std::vector<double>> milliseconds;
    for (std::uint32_t i = 0; i < runs; ++i) {
        throwIfInterrupted();
        graph.execute();
        passes = graph.timings();
        milliseconds.resize(passes.size());
        for (std::size_t p = 0; p < passes.size(); ++p)
            milliseconds[p].push_back(passes[p].milliseconds);
    }
    for (std::size_t p = 0; p < passes.size(); ++p)
        passes[p].milliseconds = timingOf(milliseconds[p]).median;
    return passes;
}

std::string rowsText(const Json& rows)
{
    std::vector<std::string> lines(rows.size() + 1);
    for (const std::string& column : columnsOf(rows)) {
        std::vector<std::string> cells = {column};
        std::size_t width = column.size();
        for (const Json& row : rows) {
            cells.push_back(cellText(row, column));
            width = std::max(width, cells.back().size());
        }
        const bool leading = lines[0].empty(); // the name: to the left; numbers: to the right
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const std::string space(width - cells[i].size(), ' ');
            lines[i] += leading ? cells[i] + space : "  " + space + cells[i];
        }
    }
    std::string text;
    for (const std::string& line : lines)
        text += line + "\n";
    return text;
}

BenchReport::BenchReport(const std::string& command, const BenchOptions& options,
                         const Context& context)
    : options_(options), about_(describeRun(command, &context))
{
    requireOutput(options.json, {".json"});
    requireOutput(options.csv, {".csv"});
    about_["date"] = utcNow();
    about_["settings"] = {{"quick", options.quick}, {"filter", options.filter}};
}

bool BenchReport::wants(const std::string& name) const
{
    return name.find(options_.filter) != std::string::npos;
}

Json savePictureSet(const std::filesystem::path& folder, const std::string& stem,
                    const std::string& title, const std::string& caption, const CpuImage& ours,
                    const CpuImage& truth)
{
    const CpuImage shown = displayImage(ours, 0.0f);
    const CpuImage wanted = displayImage(truth, 0.0f);
    savePng(folder / (stem + ".png"), shown);
    savePng(folder / (stem + "_truth.png"), wanted);
    savePng(folder / (stem + "_flip.png"), heatmap(computeFlip(shown, wanted)));
    return {{"title", title},
            {"ours", stem + ".png"},
            {"truth", stem + "_truth.png"},
            {"error", stem + "_flip.png"},
            {"caption", caption}};
}

void BenchReport::finish() const
{
    if (rows_.empty())
        throw Error("--filter: no row's name holds '" + options_.filter + "'");
    std::fputs(rowsText(rows_).c_str(), stdout);
    write();
}

void BenchReport::write() const
{
    Json json = about_;
    json["rows"] = rows_;
    writeJson(options_.json, json);
    if (!options_.csv.empty())
        writeFileAtomically(options_.csv, csvOf(rows_));
}

} // namespace strandlight::cli
