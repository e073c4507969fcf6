// What the rows of `strandlight bench gi` say: headline numbers, and how the report draws them.
#include <algorithm>
#include <cmath>
#include <map>

#include "samples/strandlight/bench_gi.hpp"

namespace strandlight::cli {

namespace {

Json fact(const std::string& label, const std::string& value)
{
    return {{"label", label}, {"value", value}};
}

std::vector<std::string> scenesOf(const Json& rows)
{
    std::vector<std::string> scenes;
    for (const Json& row : rows)
        if (row.contains("scene") &&
            std::find(scenes.begin(), scenes.end(), row["scene"]) == scenes.end())
            scenes.push_back(row["scene"]);
    return scenes;
}

// Seconds after which a fit's trace is first at or below `error`; NaN when it never is.
double secondsTo(const Json& rows, const std::string& scene, const char* fit, double error)
{
    for (const Json& row : rows)
        if (row["study"] == "fit over time" && row["scene"] == scene && row["series"] == fit &&
            row["rmse_between"].is_number() && double(row["rmse_between"]) <= error)
            return row["fit_s"];
    return kNotMeasured;
}

// Who has the least error within each budget of bytes from 56 up, where that is not a free fit: ""
// or "raw images at 1024 bytes".
std::string budgetsWithoutFree(const Json& rows, const std::string& scene)
{
    std::map<double, const Json*> best; // of each size
    for (const Json& row : rows)
        if (row["study"] == "gi" && row["scene"] == scene && row.contains("on_bytes_front")) {
            const Json*& slot = best[row["bytes_per_texel"]];
            if (!slot || row["rmse_between"] < (*slot)["rmse_between"])
                slot = &row;
        }
    std::string others;
    const Json* least = nullptr;
    for (const auto& [bytes, row] : best) {
        if (!least || (*row)["rmse_between"] < (*least)["rmse_between"])
            least = row;
        const auto series = (*least)["series"].get<std::string>();
        if (bytes >= 56.0 && !series.starts_with("free"))
            others += (others.empty() ? "" : ", ") + series + " at " + fixed(bytes, 0) + " bytes";
    }
    return others;
}

void addSceneFacts(const Json& rows, const std::string& scene, Json& facts)
{
    const std::string others = budgetsWithoutFree(rows, scene);
    facts.push_back(fact(scene + ": free SGs have the least error from 56 bytes a texel up",
                         others.empty() ? "at every budget" : "but for " + others));
    for (const Json& row : rows)
        if (row["study"] == "gi" && row["scene"] == scene && row["knob"] == "representation" &&
            row["representation"] == "cnn") {
            const double target = row["rmse_between"];
            const double cnn = row["fit_s"];
            const double direct = secondsTo(rows, scene, "direct", target);
            facts.push_back(fact(scene + ": cnn's final error between texels, " + fixed(target, 3),
                                 "cnn " + fixed(cnn, 1) + " s, direct " +
                                     (std::isfinite(direct) ? fixed(direct, 2) + " s (" +
                                                                  fixed(direct / cnn, 3) + "x)"
                                                            : std::string("never"))));
        }
}

double meanError(const Json& rows, const char* study, const std::string& series)
{
    double sum = 0.0;
    int count = 0;
    for (const Json& row : rows)
        if (row["study"] == study && row["series"] == series) {
            sum += double(row["error"]);
            ++count;
        }
    return sum / count;
}

double worstError(const Json& rows, const char* study, const std::string& series)
{
    double worst = 0.0;
    for (const Json& row : rows)
        if (row["study"] == study && row["series"] == series)
            worst = std::max(worst, double(row["error"]));
    return worst;
}

Json plot(const std::string& title, const std::string& note, const char* x, const char* y,
          const char* series, Json where)
{
    return {{"title", title},   {"note", note},  {"x", x},        {"y", y},
            {"series", series}, {"log_x", true}, {"log_y", true}, {"where", std::move(where)}};
}

void addScenePlots(const std::string& scene, Json& plots)
{
    Json bytes = plot(
        scene + ": bytes against error",
        "RMSE of the light field between texels, where no fit has looked, against what "
        "is stored for a texel. One capture, every way to keep it. Raw images are what "
        "was captured, blended: their error is parallax and noise.",
        "bytes_per_texel", "rmse_between", "series",
        {{"study", "gi"}, {"scene", scene}, {"knob", {"representation", "lobes and storage"}}});
    bytes["front"] = true;
    Json bake = plot(
        scene + ": bake time against error",
        "FLIP of the rendered picture against a path-traced truth, whose noise counts as "
        "error. Each knob is turned alone about the base.",
        "bake_s", "flip", "knob",
        {{"study", "gi"},
         {"scene", scene},
         {"knob", {"representation", "lobes and storage", "atlas", "light field", "samples"}}});
    bake["front"] = true;
    Json fits = plot(scene + ": error while fits work",
                     "The same capture and lobes; where a line ends the fit is done.", "fit_s",
                     "rmse_between", "series", {{"study", "fit over time"}, {"scene", scene}});
    fits["lines"] = true;
    Json shading = plot(
        scene + ": shading tiers",
        "FLIP against the time of the passes that read lobes, the same bake. Specular + "
        "diffuse model.",
        "shading_ms", "flip", "shading", {{"study", "gi"}, {"scene", scene}, {"knob", "shading"}});
    for (Json* each : {&bytes, &bake, &fits, &shading})
        plots.push_back(std::move(*each));
}

} // namespace

Json giFacts(const Json& rows)
{
    Json facts = Json::array();
    for (const std::string& scene : scenesOf(rows))
        addSceneFacts(rows, scene, facts);
    const double mixture = meanError(rows, "specular", "mixture (default)");
    const double asg = meanError(rows, "specular", "asg (thesis)");
    facts.push_back(
        fact("glossy closed form, mean error: mixture over the thesis's ASG",
             fixed(mixture, 3) + " / " + fixed(asg, 3) + " = " + fixed(mixture / asg, 3)));
    const double diffuse = worstError(rows, "diffuse", "Tokuyoshi 2024 (default)");
    facts.push_back(fact("diffuse closed form, largest error for sharpness 1e-3 to 1e5",
                         fixed(1e3 * diffuse, 2) + "e-3 of the lobe's energy"));
    return facts;
}

Json giPlots(const Json& rows)
{
    Json plots = Json::array();
    for (const std::string& scene : scenesOf(rows))
        addScenePlots(scene, plots);
    Json specular =
        plot("Glossy closed forms",
             "Mean relative error of a GGX reflection of one lobe over sharpness 1 to 256 and "
             "views of 0 to 80 degrees, against quadrature.",
             "alpha", "error", "series", {{"study", "specular"}});
    Json diffuse =
        plot("Diffuse closed forms",
             "Largest error of a lobe's irradiance over all angles, as a share of its energy, "
             "against quadrature.",
             "sharpness", "error", "series", {{"study", "diffuse"}});
    for (Json* each : {&specular, &diffuse}) {
        (*each)["lines"] = true;
        plots.push_back(std::move(*each));
    }
    return plots;
}

Json giTables()
{
    const auto table = [](const char* title, const char* note, Json knob, Json columns) -> Json {
        return {{"title", title},
                {"note", note},
                {"columns", std::move(columns)},
                {"where", {{"study", "gi"}, {"knob", std::move(knob)}}}};
    };
    return {
        table("Ways to keep a light field", "One capture.", "representation",
              {"name", "bytes_per_texel", "fit_s", "rmse_texel", "rmse_between", "flip", "ssim"}),
        table("Sizes", "One knob at a time.", {"atlas", "light field", "samples"},
              {"name", "texels", "bake_s", "rmse_between", "flip", "relmse"}),
        table("Lobes and storage", "The direct fit.", "lobes and storage",
              {"name", "bytes_per_texel", "rmse_between", "flip", "shading_ms"}),
        table("Shading tiers", "Specular + diffuse model.", "shading",
              {"name", "shading_ms", "flip", "relmse", "ssim"})};
}

Json giColumns()
{
    const auto column = [](const char* label, const char* unit) -> Json {
        return {{"label", label}, {"unit", unit}};
    };
    return {{"name", column("", "")},
            {"texels", column("texels", "")},
            {"bytes_per_texel", column("stored per texel", "bytes")},
            {"capture_s", column("capture", "s")},
            {"fit_s", column("fit", "s")},
            {"bake_s", column("bake", "s")},
            {"shading_ms", column("shading", "ms")},
            {"rmse_texel", column("RMSE at texels", "")},
            {"rmse_between", column("RMSE between texels", "")},
            {"flip", column("FLIP", "")},
            {"relmse", column("relMSE", "")},
            {"ssim", column("SSIM", "")},
            {"alpha", column("roughness alpha", "")},
            {"sharpness", column("sharpness", "")},
            {"error", column("error", "")}};
}

} // namespace strandlight::cli
