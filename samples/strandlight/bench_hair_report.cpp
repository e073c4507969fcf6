#include "samples/strandlight/bench_hair.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace strandlight::cli {

namespace {

std::vector<std::string> distinct(const Json& rows, const char* key)
{
    std::vector<std::string> values;
    for (const Json& row : rows)
        if (std::find(values.begin(), values.end(), row[key]) == values.end())
            values.push_back(row[key]);
    return values;
}

const Json* find(const Json& rows, const std::string& scene, const std::string& method)
{
    for (const Json& row : rows)
        if (row["scene"] == scene && row["method"] == method)
            return &row;
    return nullptr;
}

// A number of the filter's over that of another method.
std::string over(const Json& filtered, const Json& other, const char* key)
{
    return fixed(double(filtered[key]) / double(other[key]), 3);
}

Json plot(const std::string& title, const std::string& scene, const char* y)
{
    return {
        {"title", title},
        {"note", "Against a supersampled truth of true-width strands; time of the whole frame."},
        {"x", "ms"},
        {"y", y},
        {"series", "series"},
        {"log_x", true},
        {"log_y", true},
        {"front", true},
        {"where", {{"scene", scene}}}};
}

} // namespace

std::string hairSeries(const std::string& method)
{
    const std::string filter = method.substr(method.find(' ') + 1);
    const std::size_t variant = filter.find(", ");
    return variant == std::string::npos ? filter : filter.substr(0, variant) + ", other settings";
}

Json hairMeans(const Json& rows)
{
    Json means = Json::array();
    const std::size_t scenes = distinct(rows, "scene").size();
    for (const std::string& method : distinct(rows, "method")) {
        Json mean = {{"name", "mean " + method},
                     {"scene", std::string(kAllScenes)},
                     {"method", method},
                     {"series", hairSeries(method)}};
        std::size_t count = 0;
        for (const Json& row : rows) {
            if (row["method"] != method)
                continue;
            ++count;
            for (const auto& [key, value] : row.items())
                if (value.is_number())
                    mean[key] = mean.value(key, 0.0) + double(value) / double(scenes);
        }
        if (count == scenes)
            means.push_back(std::move(mean));
    }
    return means;
}

Json hairFacts(const Json& rows)
{
    Json facts = Json::array();
    for (const std::string& method : distinct(rows, "method")) {
        if (!method.starts_with("4 U-Net") || method.find(',') != std::string::npos)
            continue;
        std::size_t better = 0, scenes = 0;
        for (const std::string& scene : distinct(rows, "scene")) {
            const Json* filtered = find(rows, scene, method);
            const Json* four = find(rows, scene, "4 averaged");
            const Json* many = find(rows, scene, "64 averaged");
            if (!filtered || !four || !many)
                continue;
            ++scenes;
            better += (*filtered)["rmse"] < (*many)["rmse"] ? 1 : 0;
            facts.push_back(
                {{"label", scene + ", " + method},
                 {"value", "RMSE " + over(*filtered, *four, "rmse") + " of 4 averaged, " +
                               over(*filtered, *many, "rmse") + " of 64 averaged; flicker " +
                               over(*filtered, *four, "flicker") + " of 4 averaged, time " +
                               over(*filtered, *many, "ms") + " of 64 averaged"}});
        }
        facts.push_back(
            {{"label", method + " has lower RMSE than 64 averaged"},
             {"value", "on " + std::to_string(better) + " of " + std::to_string(scenes)}});
    }
    return facts;
}

Json hairPlots(const Json& rows)
{
    Json plots = {plot("Error against time, mean of all frames", kAllScenes, "rmse"),
                  plot("FLIP against time, mean of all frames", kAllScenes, "flip")};
    for (const std::string& scene : distinct(rows, "scene"))
        if (scene != kAllScenes)
            plots.push_back(plot(scene + ": error against time", scene, "rmse"));
    return plots;
}

Json hairTables(const Json& rows)
{
    std::vector<std::string> scenes = distinct(rows, "scene");
    std::erase(scenes, kAllScenes);
    return {{{"title", "Mean of all frames"},
             {"columns",
              {"method", "rmse", "rmse_over_4", "psnr_db", "ssim", "flip", "coverage_error",
               "flicker", "ms"}},
             {"where", {{"scene", kAllScenes}}}},
            {{"title", "Every frame"},
             {"columns",
              {"name", "rmse", "rmse_over_4", "psnr_db", "ssim", "flip", "coverage_error",
               "flicker", "ms"}},
             {"where", {{"scene", scenes}}}},
            {{"title", "Milliseconds by pass"},
             {"note", "Mean of all frames."},
             {"columns",
              {"method", "ms", "ms_shadow", "ms_strands", "ms_coverage", "ms_blend", "ms_network",
               "ms_composite"}},
             {"where", {{"scene", kAllScenes}}}}};
}

Json hairColumns()
{
    const auto column = [](const char* label, const char* unit) -> Json {
        return {{"label", label}, {"unit", unit}};
    };
    return {{"name", column("", "")},
            {"method", column("", "")},
            {"rmse", column("RMSE", "")},
            {"rmse_over_4", column("over 4 averaged", "")},
            {"psnr_db", column("PSNR", "dB")},
            {"ssim", column("SSIM", "")},
            {"flip", column("FLIP", "")},
            {"coverage_error", column("coverage error", "")},
            {"flicker", column("flicker", "")},
            {"ms", column("frame", "ms")},
            {"ms_shadow", column("shadow maps", "ms")},
            {"ms_strands", column("strands", "ms")},
            {"ms_coverage", column("coverage", "ms")},
            {"ms_blend", column("blended strands", "ms")},
            {"ms_network", column("network", "ms")},
            {"ms_composite", column("composite", "ms")},
            {"rmse_from_fp32", column("RMSE from fp32", "")}};
}

} // namespace strandlight::cli
