#include "samples/strandlight/report_page.hpp"

#include <algorithm>

#include "samples/strandlight/html.hpp"

namespace strandlight::cli {

namespace {

std::string fact(const std::string& name, const std::string& value, const std::string& unit = "")
{
    return "<div><dt>" + name + "</dt><dd>" + value +
           (unit.empty() ? "" : " <small>" + unit + "</small>") + "</dd></div>\n";
}

std::string row(const std::string& name, const std::string& value)
{
    return "<tr><th scope=\"row\">" + escapeHtml(name) + "</th><td class=\"n\">" + value +
           "</td></tr>\n";
}

std::string header(const ReportPage& page)
{
    std::string made = "Strandlight " + std::string(version());
    if (*commit())
        made += ", commit <code>" + escapeHtml(commit()) + "</code>";
    for (const Json* run : {&page.render, &page.bake, &page.truth})
        if (run->contains("device")) {
            const Json& device = (*run)["device"];
            made += "<br>" + escapeHtml(device.value("name", "")) + ", driver " +
                    escapeHtml(device.value("driver", ""));
            break;
        }
    return "<header><h1>" + escapeHtml(page.title) + "</h1>\n<p class=\"soft\">" + made +
           "</p></header>\n";
}

std::string facts(const ReportPage& page)
{
    const ImageComparison& c = page.comparison;
    std::string list = fact("FLIP", fixed(c.flip, 3), "0 is equal") +
                       fact("relMSE", fixed(c.relMse, 4)) + fact("SSIM", fixed(c.ssim, 3)) +
                       fact("PSNR", fixed(c.psnr, 1), "dB");
    if (page.bake.contains("result"))
        list += fact("bake", fixed(page.bake["result"].value("seconds", 0.0), 0), "s");
    if (page.render.contains("result"))
        list += fact("frame", fixed(page.render["result"].value("milliseconds", 0.0), 0), "ms");
    return "<dl class=\"facts\">\n" + list + "</dl>\n";
}

std::string pictures(const ReportPage& page)
{
    const CpuImage ours = displayImage(page.picture, page.exposure);
    const CpuImage truth = displayImage(page.reference, page.exposure);
    return "<section aria-label=\"Pictures\">\n" + htmlSwipe(ours, truth) +
           htmlTriptych(ours, truth, heatmap(page.flip)) + "</section>\n";
}

std::string metrics(const ImageComparison& c)
{
    const auto percent = [](double ours, double truth) {
        return " (" + std::string(ours < truth ? "" : "+") +
               fixed(100.0 * (ours / truth - 1.0), 2) + " %)";
    };
    const double mean = (c.referenceMean.r + c.referenceMean.g + c.referenceMean.b) / 3.0;
    std::string rows = row("RMSE", fixed(c.rmse, 5)) + row("relMSE", fixed(c.relMse, 5)) +
                       row("RMSE of 8x8 pixel means", fixed(c.blockRmse, 5) + " (" +
                                                          fixed(100.0 * c.blockRmse / mean, 2) +
                                                          " % of the mean)") +
                       row("PSNR", fixed(c.psnr, 2) + " dB") + row("SSIM", fixed(c.ssim, 4)) +
                       row("FLIP", fixed(c.flip, 4));
    static const char* const kChannels[] = {"red", "green", "blue"};
    for (int i = 0; i < 3; ++i)
        rows += row(std::string("mean ") + kChannels[i],
                    fixed(c.mean[i], 4) + percent(c.mean[i], c.referenceMean[i]));
    return htmlTable("Against the truth", rows);
}

std::string bakeTable(const Json& bake)
{
    if (!bake.contains("result"))
        return "";
    const Json& r = bake["result"];
    const auto whole = [&](const char* key) { return std::to_string(r.value(key, 0ull)); };
    const auto seconds = [&](const char* key) { return fixed(r.value(key, 0.0), 1) + " s"; };
    return htmlTable(
        "The bake",
        row("texels with surface", whole("texels")) +
            row("of them inside geometry", whole("skipped_texels")) +
            row("charts", whole("charts")) + row("bytes per texel", whole("bytes_per_texel")) +
            row("file", bytesText(r.value("file_bytes", 0ull))) +
            row("light field RMSE", fixed(r.value("radiance_rmse", 0.0), 4)) +
            row("atlas", seconds("atlas_seconds")) + row("capture", seconds("capture_seconds")) +
            row("fit", seconds("fit_seconds")) + row("together", seconds("seconds")) +
            row("device memory, peak", bytesText(r.value("peak_device_bytes", 0ull))));
}

std::string framePasses(const Json& render)
{
    return render.contains("result") ? passTable("Passes of the frame", render["result"]["passes"],
                                                 render["result"]["skipped"])
                                     : "";
}

std::string settingText(const Json& value)
{
    if (value.is_string())
        return value.get<std::string>().empty() ? "none" : value.get<std::string>();
    if (value.is_number_float())
        return fixed(value.get<double>(), 3);
    if (!value.is_structured())
        return value.dump();
    std::string text; // a camera: "eye 1, 2, 3; ..."
    for (const auto& [key, part] : value.items())
        text += (text.empty()       ? ""
                 : value.is_array() ? ", "
                                    : "; ") +
                (value.is_array() ? settingText(part) : key + " " + settingText(part));
    return text;
}

std::string settings(const char* caption, const Json& run)
{
    if (!run.contains("settings"))
        return "";
    std::string rows;
    for (const auto& [key, value] : run["settings"].items()) {
        std::string name = key;
        std::replace(name.begin(), name.end(), '_', ' ');
        rows += "<tr><th scope=\"row\">" + escapeHtml(name) + "</th><td><code>" +
                escapeHtml(settingText(value)) + "</code></td></tr>\n";
    }
    return "<div>" + htmlTable(caption, rows) + "</div>\n";
}

} // namespace

std::string passTable(const std::string& title, const Json& passes, const Json& skipped)
{
    double slowest = 1e-6;
    for (const Json& pass : passes)
        slowest = std::max(slowest, pass.value("milliseconds", 0.0));
    std::string rows;
    for (const Json& pass : passes) {
        const double ms = pass.value("milliseconds", 0.0);
        rows += "<tr><th scope=\"row\">" + escapeHtml(pass.value("name", "")) +
                "</th><td class=\"n\">" + fixed(ms, 2) +
                " ms</td><td class=\"bar\"><i style=\"width:" + fixed(100.0 * ms / slowest, 1) +
                "%\"></i></td></tr>\n";
    }
    std::string notRun;
    for (const Json& pass : skipped)
        notRun += (notRun.empty() ? "" : "; ") + escapeHtml(pass.get<std::string>());
    if (!notRun.empty())
        notRun = "<p class=\"soft note\">Not run: " + notRun + ".</p>\n";
    return htmlTable(title, rows) + notRun;
}

std::string reportHtml(const ReportPage& page)
{
    return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
           escapeHtml(page.title) + " - Strandlight</title>\n<style>" + kReportStyle +
           "</style>\n</head>\n<body>\n<main>\n" + header(page) + facts(page) + pictures(page) +
           "<div class=\"columns\">\n<div>" + metrics(page.comparison) + "</div>\n<div>" +
           framePasses(page.render) + "</div>\n<div>" + bakeTable(page.bake) + "</div>\n" +
           settings("Settings of the bake", page.bake) +
           settings("Settings of the frame", page.render) +
           settings("Settings of the truth", page.truth) + "</div>\n</main>\n<script>" +
           kReportScript + "</script>\n</body>\n</html>\n";
}

} // namespace strandlight::cli
