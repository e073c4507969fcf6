// strandlight fits: one capture, kept in every way there is, measured at texels and between them.
#include <cmath>
#include <cstdio>
#include <memory>

#include "passes/fit_study.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

namespace {

struct Options
{
    DeviceOptions device;
    SceneOptions scene;
    FitStudySettings settings;
    std::vector<std::string> modes{"cnn", "direct", "cnn+refine"};
    std::string json;
};

Json describe(const Options& o, const Context& context, const FitReport& report)
{
    const FitStudySettings& s = o.settings;
    Json json = describeRun("fits", &context);
    json["settings"] = {{"scene", o.scene.scene},
                        {"environment", o.scene.environment},
                        {"atlas", s.atlasResolution},
                        {"lightfield", s.capture.size},
                        {"spp", s.capture.samplesPerDirection},
                        {"bounces", s.capture.bounces},
                        {"lobes", s.fit.lobes},
                        {"steps", s.fit.steps},
                        {"seed", s.capture.seed}};
    const auto number = [](double value) {
        return std::isfinite(value) ? Json(value) : Json(nullptr);
    };
    Json rows = Json::array();
    for (const FitReportRow& row : report.rows)
        rows.push_back({{"model", row.name},
                        {"texel_rmse", number(row.texelRmse)},
                        {"interpolated_rmse", number(row.interpolatedRmse)},
                        {"texel_irradiance_error", number(row.texelIrradiance)},
                        {"interpolated_irradiance_error", number(row.interpolatedIrradiance)},
                        {"bytes_per_texel", row.bytesPerTexel},
                        {"seconds", row.seconds}});
    json["result"] = {{"signal_rms", report.signalRms},
                      {"texels", report.texels},
                      {"points_between", report.probes},
                      {"rows", rows}};
    return json;
}

int run(Options& o)
{
    requireOutput(o.json, {".json"});
    o.settings.fit.seed = o.settings.capture.seed;
    o.settings.modes.clear();
    for (const std::string& mode : o.modes)
        o.settings.modes.push_back(fitModeFrom(mode));
    const Scene scene = openScene(o.scene);
    Context context = openDevice(o.device);
    const FitReport report = studyFits(context, scene, o.settings);
    std::fputs(report.text().c_str(), stdout);
    writeJson(o.json, describe(o, context, report));
    return 0;
}

} // namespace

Command addFits(CLI::App& parent)
{
    CLI::App* app =
        parent.add_subcommand("fits", "Measure the ways to keep a light field on one capture");
    const auto o = std::make_shared<Options>();
    FitStudySettings& s = o->settings;
    addSceneOptions(*app, o->scene);
    addNumber(*app, "--atlas", s.atlasResolution, "Texels per side of the atlas", 8u, 1024u);
    addNumber(*app, "--lightfield", s.capture.size, "Directions per side of a texel's image", 4u,
              64u);
    addNumber(*app, "--spp", s.capture.samplesPerDirection, "Paths per direction", 1u, 65536u);
    addNumber(*app, "--bounces", s.capture.bounces, "Reflections on a path", 0u, 64u);
    addNumber(*app, "--lobes", s.fit.lobes, "Spherical gaussians per texel", 1u, 32u);
    addNumber(*app, "--steps", s.fit.steps, "Steps of the direct fit's last level", 0u, 1000000u);
    addNumber(*app, "--seed", s.capture.seed, "Of the random numbers", 0u, 0xffffffffu);
    app->add_option("--fit", o->modes, "Free-lobe modes, after the others")
        ->type_name("MODES")
        ->delimiter(',')
        ->allow_extra_args(false) // the scene may follow
        ->capture_default_str()
        ->check(CLI::IsMember({"direct", "cnn", "cnn+refine"}));
    app->add_option("--lobe-error", s.lobeErrors,
                    "Adds the direct fit with lobes dropped, as in bake; one row each")
        ->type_name("E,E,...")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(0.0f, 10.0f));
    addNumber(*app, "--lobe-tile", s.fit.lobeTile, "Texels a side that keep the same lobes", 1u,
              64u);
    addJsonOption(*app, o->json);
    addDeviceOptions(*app, o->device);
    addExamples(*app, "  strandlight fits builtin:room --json fits.json\n"
                      "  strandlight fits builtin:room --fit direct --lobes 12\n"
                      "Points between lie in the middle of four texels: light that no fit has "
                      "seen.");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
