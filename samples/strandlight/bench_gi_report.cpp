// How the report draws the rows of `strandlight bench gi`.
#include <algorithm>

#include "samples/strandlight/bench_gi.hpp"

namespace strandlight::cli {

std::vector<std::string> giScenes(const Json& rows)
{
    std::vector<std::string> scenes;
    for (const Json& row : rows)
        if (row.contains("scene") &&
            std::find(scenes.begin(), scenes.end(), row["scene"]) == scenes.end())
            scenes.push_back(row["scene"]);
    return scenes;
}

namespace {

Json plot(const std::string& title, const std::string& note, const char* x, const char* y,
          const char* series, Json where)
{
    return {{"title", title},   {"note", note},  {"x", x},        {"y", y},
            {"series", series}, {"log_x", true}, {"log_y", true}, {"where", std::move(where)}};
}

void addScenePlots(const std::string& scene, Json& plots)
{
    Json bytes =
        plot(scene + ": bytes against error",
             "RMSE of the light field between texels, where no fit has looked, against what "
             "is stored for a texel. One capture, every way to keep it. Raw images are what "
             "was captured, blended: their error is parallax and noise.",
             "bytes_per_texel", "rmse_between", "series",
             {{"study", "gi"},
              {"scene", scene},
              {"knob", {"representation", "lobes and storage", "dropped lobes"}}});
    bytes["front"] = true;
    Json bake =
        plot(scene + ": bake time against error",
             "FLIP of the rendered picture against a path-traced truth, whose noise counts as "
             "error. Each knob is turned alone about the base.",
             "bake_s", "flip", "knob",
             {{"study", "gi"},
              {"scene", scene},
              {"knob",
               {"representation", "lobes and storage", "dropped lobes", "atlas", "light field",
                "samples"}}});
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

Json giPlots(const Json& rows)
{
    Json plots = Json::array();
    for (const std::string& scene : giScenes(rows))
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
        table("Lobes and storage", "The direct fit.",
              {"base", "lobes and storage", "dropped lobes"},
              {"name", "bytes_per_texel", "rmse_texel", "rmse_between", "flip", "relmse",
               "shading_ms"}),
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
