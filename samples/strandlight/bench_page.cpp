#include "samples/strandlight/bench_page.hpp"

#include <algorithm>
#include <cstdio>

#include "engine/base/image_io.hpp"
#include "samples/strandlight/html.hpp"
#include "samples/strandlight/report_page.hpp"
#include "samples/strandlight/svg_plot.hpp"

namespace strandlight::cli {

namespace {

std::string labelOf(const Json& bench, const std::string& key, bool withUnit)
{
    const Json column = bench.value("columns", Json::object()).value(key, Json::object());
    std::string label = column.value("label", key);
    std::replace(label.begin(), label.end(), '_', ' ');
    const std::string unit = column.value("unit", "");
    return withUnit && !unit.empty() ? label + ", " + unit : label;
}

std::string valueText(const Json& value)
{
    if (value.is_null())
        return "";
    if (value.is_string())
        return value.get<std::string>();
    if (!value.is_number_float())
        return value.dump();
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value.get<double>());
    return text;
}

bool chosen(const Json& row, const Json& where)
{
    return std::all_of(where.items().begin(), where.items().end(), [&](const auto& condition) {
        const Json value = row.value(condition.key(), Json(nullptr));
        const Json& wanted = condition.value();
        return wanted.is_array() ? std::find(wanted.begin(), wanted.end(), value) != wanted.end()
                                 : value == wanted;
    });
}

std::string detailsOf(const Json& bench, const Json& row)
{
    std::string text;
    for (const auto& [key, value] : row.items())
        if (!value.is_null() && key != "study" && key != "series")
            text += (text.empty() ? "" : "\n") +
                    (key == "name" ? "" : labelOf(bench, key, true) + ": ") + valueText(value);
    return text;
}

Plot plotOf(const Json& bench, const Json& spec)
{
    Plot plot;
    plot.title = spec.value("title", "");
    const std::string x = spec.value("x", ""), y = spec.value("y", "");
    const std::string series = spec.value("series", "");
    plot.x = {labelOf(bench, x, true), spec.value("log_x", true)};
    plot.y = {labelOf(bench, y, true), spec.value("log_y", true)};
    plot.lines = spec.value("lines", false);
    plot.front = spec.value("front", false);
    for (const Json& row : bench["rows"])
        if (chosen(row, spec.value("where", Json::object())) && row.contains(x) &&
            row[x].is_number() && row.contains(y) && row[y].is_number())
            plot.points.push_back(
                {row[x], row[y], valueText(row.value(series, Json(""))), detailsOf(bench, row)});
    return plot;
}

std::string legend(const Plot& plot)
{
    const std::vector<std::string> series = plotSeries(plot);
    std::string html = "<p class=\"legend\">";
    for (std::size_t i = 0; i < series.size(); ++i) {
        const int index = int(i) % kPlotSeries;
        html += "<span class=\"s" + std::to_string(index) +
                "\"><svg viewBox=\"0 0 14 14\" aria-hidden=\"true\">" + svgMark(index, 7.0, 7.0) +
                "</svg>" + escapeHtml(series[i]) + "</span> ";
    }
    if (plot.front)
        html += "<span><svg class=\"wide\" viewBox=\"0 0 26 14\" aria-hidden=\"true\"><line "
                "class=\"front\" x1=\"1\" y1=\"7\" x2=\"25\" y2=\"7\"/></svg>Pareto front</span>";
    return html + "</p>";
}

std::string plots(const Json& bench)
{
    std::string html;
    for (const Json& spec : bench.value("plots", Json::array())) {
        const Plot plot = plotOf(bench, spec);
        const std::string svg = svgPlot(plot);
        if (!svg.empty())
            html += "<figure class=\"chart\"><h3>" + escapeHtml(plot.title) +
                    "</h3>\n<p class=\"soft\">" + escapeHtml(spec.value("note", "")) + "</p>" +
                    legend(plot) + svg + "</figure>\n";
    }
    return html.empty() ? "" : "<div class=\"charts\">\n" + html + "</div>\n";
}

std::vector<std::string> columnsOf(const Json& bench, const Json& spec)
{
    if (spec.contains("columns"))
        return spec["columns"];
    std::vector<std::string> columns;
    for (const Json& row : bench["rows"])
        for (const auto& [key, value] : row.items())
            if (std::find(columns.begin(), columns.end(), key) == columns.end())
                columns.push_back(key);
    return columns;
}

std::string table(const Json& bench, const Json& spec)
{
    const std::vector<std::string> columns = columnsOf(bench, spec);
    std::string head, body;
    for (std::size_t c = 0; c < columns.size(); ++c)
        head += std::string("<th scope=\"col\"") + (c > 0 ? " class=\"n\"" : "") + ">" +
                escapeHtml(labelOf(bench, columns[c], true)) + "</th>";
    for (const Json& row : bench["rows"]) {
        if (!chosen(row, spec.value("where", Json::object())))
            continue;
        body += "<tr>";
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const std::string text = escapeHtml(valueText(row.value(columns[c], Json(nullptr))));
            body += c == 0 ? "<th scope=\"row\">" + text + "</th>"
                           : "<td class=\"n\">" + text + "</td>";
        }
        body += "</tr>\n";
    }
    if (body.empty())
        return "";
    return "<div class=\"wide-table\"><table><caption>" + escapeHtml(spec.value("title", "")) +
           " <small class=\"soft\">" + escapeHtml(spec.value("note", "")) +
           "</small></caption>\n<thead><tr>" + head + "</tr></thead>\n<tbody>" + body +
           "</tbody></table></div>\n";
}

std::string tables(const Json& bench)
{
    if (!bench.contains("tables"))
        return table(bench, {{"title", "All rows"}});
    std::string html;
    for (const Json& spec : bench["tables"])
        html += table(bench, spec);
    return html;
}

std::string pictures(const Json& bench, const std::filesystem::path& folder)
{
    std::string html;
    for (const Json& spec : bench.value("pictures", Json::array())) {
        const CpuImage ours = loadImage(folder / spec.value("ours", ""));
        const CpuImage truth = loadImage(folder / spec.value("truth", ""));
        const CpuImage error = loadImage(folder / spec.value("error", ""));
        html += "<figure class=\"pictures\"><h3>" + escapeHtml(spec.value("title", "")) +
                "</h3><p class=\"soft\">" + escapeHtml(spec.value("caption", "")) + "</p>" +
                htmlSwipe(ours, truth) + htmlTriptych(ours, truth, error) + "</figure>\n";
    }
    return html;
}

std::string passes(const Json& bench)
{
    std::string html;
    for (const Json& spec : bench.value("passes", Json::array()))
        html +=
            "<div>" +
            passTable(spec.value("title", ""), spec["rows"], spec.value("skipped", Json::array())) +
            "</div>\n";
    return html.empty() ? "" : "<div class=\"columns\">\n" + html + "</div>\n";
}

std::string facts(const Json& bench)
{
    std::string rows;
    for (const Json& fact : bench.value("facts", Json::array()))
        rows += "<tr><th scope=\"row\">" + escapeHtml(fact.value("label", "")) + "</th><td>" +
                escapeHtml(fact.value("value", "")) + "</td></tr>\n";
    return rows.empty() ? "" : "<table class=\"findings\">" + rows + "</table>\n";
}

// "bench gi" is the section "gi".
std::string idOf(const Json& bench)
{
    const std::string command = bench.value("command", "bench");
    return escapeHtml(command.substr(command.rfind(' ') + 1));
}

std::string titleOf(const std::string& id)
{
    return id == "gi"        ? "Baked light"
           : id == "hair"    ? "Hair"
           : id == "skip"    ? "What a scene does not need"
           : id == "kernels" ? "Kernels"
                             : id;
}

std::string section(const Json& bench, const std::filesystem::path& folder)
{
    const std::string id = idOf(bench);
    return "<section id=\"" + id + "\"><h2>" + titleOf(id) + "</h2>\n" + facts(bench) +
           pictures(bench, folder) + plots(bench) + passes(bench) + tables(bench) + "</section>\n";
}

std::string header(const std::vector<Json>& benches)
{
    const Json first = benches.empty() ? Json::object() : benches.front();
    std::string made = "Strandlight " + escapeHtml(first.value("version", version()));
    if (const std::string from = first.value("commit", ""); !from.empty())
        made += ", commit <code>" + escapeHtml(from) + "</code>";
    made += ", " + escapeHtml(first.value("date", ""));
    if (first.contains("device")) {
        const Json& device = first["device"];
        made += "<br>" + escapeHtml(device.value("name", "")) + ", driver " +
                escapeHtml(device.value("driver", ""));
    }
    std::string links;
    for (const Json& bench : benches)
        links += "<a href=\"#" + idOf(bench) + "\">" + titleOf(idOf(bench)) + "</a> ";
    return "<header><h1>Run time against error</h1>\n<p class=\"soft\">" + made + "</p>\n<nav>" +
           links + "</nav></header>\n";
}

} // namespace

std::string benchPageHtml(const std::vector<Json>& benches, const std::filesystem::path& folder)
{
    std::string sections;
    for (const Json& bench : benches)
        sections += section(bench, folder);
    return std::string("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                       "<title>Strandlight benchmarks</title>\n<style>") +
           kReportStyle + kBenchPageStyle + "</style>\n</head>\n<body>\n<main>\n" +
           header(benches) + sections + "</main>\n<div id=\"hint\" hidden></div>\n<script>" +
           kReportScript + kBenchPageScript + "</script>\n</body>\n</html>\n";
}

} // namespace strandlight::cli
