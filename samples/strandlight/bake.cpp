// strandlight bake: scene to .sgl.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "engine/base/error.hpp"
#include "passes/bake.hpp"
#include "passes/bake_memory.hpp"
#include "passes/sgl_file.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/outputs.hpp"
#include "samples/strandlight/savings_text.hpp"

namespace strandlight::cli {

namespace {

struct Options
{
    DeviceOptions device;
    SceneOptions scene;
    BakeSettings settings;
    std::string fit = toString(BakeSettings{}.fit);
    std::string storage = "packed";
    std::string output;
    std::string json;
    bool memory = false;
};

void addSettings(CLI::App& app, Options& o)
{
    BakeSettings& s = o.settings;
    addNumber(app, "--atlas", s.atlasResolution, "Texels per side of the atlas", 8u, 4096u);
    addNumber(app, "--lightfield", s.lightfieldSize, "Directions per side of a texel's image", 4u,
              64u);
    addNumber(app, "--lobes", s.lobes, "Spherical gaussians per texel", 1u, 32u);
    addNumber(app, "--env-lobes", s.environmentLobes, "The same for the environment's visibility",
              1u, 32u);
    app.add_option(
           "--lobe-error", s.lobeError,
           "Lobes are dropped while the fit's error grows by no more than this fraction; 0: "
           "all are kept")
        ->type_name("E")
        ->capture_default_str()
        ->check(CLI::Range(0.0f, 10.0f));
    addNumber(app, "--lobe-tile", s.lobeTile, "Texels a side that keep the same lobes", 1u, 64u);
    app.add_option("--fit", o.fit, "How lobes are found")
        ->type_name("MODE")
        ->capture_default_str()
        ->check(CLI::IsMember({"direct", "cnn", "cnn+refine"}));
    addNumber(app, "--steps", s.steps,
              "Of the direct fit; blocks of 2 x 2 texels take twice, of 4 x 4 four times as many",
              0u, 1000000u);
    addNumber(app, "--spp", s.samplesPerDirection, "Paths per direction", 1u, 65536u);
    addNumber(app, "--bounces", s.bounces, "Reflections on a path", 0u, 64u);
    addNumber(app, "--seed", s.seed, "Of the random numbers", 0u, 0xffffffffu);
    app.add_option("--storage", o.storage, "packed: 8 bytes per lobe; fp16: 12")
        ->type_name("FORM")
        ->capture_default_str()
        ->check(CLI::IsMember({"fp16", "packed"}));
    app.add_flag("--resume", s.resume, "Go on from the checkpoint of an interrupted bake");
}

SglStorage storageOf(const Options& o)
{
    return o.storage == "packed" ? SglStorage::Packed : SglStorage::Fp16;
}

std::uint64_t bytesPerLobe(const Options& o)
{
    return sglBytesPerLobe(storageOf(o));
}

// The checkpoint lives beside the result and is gone when that is written.
std::filesystem::path checkpointOf(const std::string& output)
{
    return output + ".checkpoint";
}

Json describe(const Options& o, const Context& context, const SgBake& bake,
              const BakeStatistics& statistics, const SglSaveReport& saved, double seconds)
{
    const BakeSettings& s = o.settings;
    Json json = describeRun("bake", &context);
    json["settings"] = {{"scene", o.scene.scene},
                        {"environment", o.scene.environment},
                        {"atlas", s.atlasResolution},
                        {"lightfield", s.lightfieldSize},
                        {"lobes", s.lobes},
                        {"environment_lobes", s.environmentLobes},
                        {"lobe_error", s.lobeError},
                        {"lobe_tile", s.lobeTile},
                        {"fit", o.fit},
                        {"steps", s.steps},
                        {"spp", s.samplesPerDirection},
                        {"bounces", s.bounces},
                        {"seed", s.seed},
                        {"storage", o.storage}};
    json["result"] = {{"file", o.output},
                      {"file_bytes", saved.fileBytes},
                      {"charts", bake.atlas.chartCount},
                      {"sharing_charts", bake.atlas.sharingCharts},
                      {"texels", statistics.texels},
                      {"skipped_texels", statistics.skippedTexels},
                      {"empty_texels", statistics.emptyTexels},
                      {"bytes_per_texel", saved.lobeBytesPerTexel},
                      {"savings", describeSavings(statistics.savings, bytesPerLobe(o))},
                      {"skipped", statistics.skipped},
                      {"capture_dispatches", statistics.captureDispatches},
                      {"radiance_rmse", statistics.radianceRmse},
                      {"environment_rmse", statistics.environmentRmse},
                      {"peak_device_bytes", statistics.peakDeviceBytes},
                      {"atlas_seconds", statistics.atlasSeconds},
                      {"capture_seconds", statistics.captureSeconds},
                      {"fit_seconds", statistics.fitSeconds},
                      {"seconds", seconds}};
    return json;
}

void print(const Options& o, const Context& context, const SgBake& bake,
           const BakeStatistics& statistics, const SglSaveReport& saved, double seconds)
{
    std::printf("device    %s\n", context.device().name.c_str());
    if (bake.atlas.sharingCharts > 0)
        std::printf("charts    %u more share texels with others: the atlas is too small for them\n",
                    bake.atlas.sharingCharts);
    std::printf("atlas     %ux%u, %u charts, %u texels with surface, %u of them inside geometry\n",
                bake.atlas.resolution, bake.atlas.resolution, bake.atlas.chartCount,
                statistics.texels, statistics.skippedTexels);
    std::printf("lobes     %u per texel, %.1f bytes per texel, light field RMSE %.4g\n",
                bake.radiance.lobeCount, saved.lobeBytesPerTexel, statistics.radianceRmse);
    if (bake.environment)
        std::printf("window    %u lobes per texel for the environment, RMSE %.4g\n",
                    bake.environment->lobeCount, statistics.environmentRmse);
    for (const std::string& part : statistics.skipped)
        std::printf("skipped   %s\n", part.c_str());
    printSavings(statistics.savings, bytesPerLobe(o));
    std::printf("seconds   %.1f: atlas %.1f, capture %.1f, fit %.1f\n", seconds,
                statistics.atlasSeconds, statistics.captureSeconds, statistics.fitSeconds);
    std::printf("wrote     %s, %s\n", o.output.c_str(), bytesText(saved.fileBytes).c_str());
}

int run(Options& o)
{
    const auto start = std::chrono::steady_clock::now();
    requireOutput(o.output, {".sgl"});
    requireOutput(o.json, {".json"});
    o.settings.fit = fitModeFrom(o.fit);
    o.settings.checkpoint = checkpointOf(o.output);
    const Scene scene = openScene(o.scene);
    Context context = openDevice(o.device);
    if (o.memory) {
        std::printf("%s", planBakeMemory(context, scene, o.settings).text.c_str());
        return 0;
    }

    BakeStatistics statistics;
    const SgBake bake = bakeScene(context, scene, o.settings, &statistics);
    const SglSaveReport saved = saveSgl(o.output, bake, storageOf(o));
    std::filesystem::remove(o.settings.checkpoint);

    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    print(o, context, bake, statistics, saved, elapsed.count());
    writeJson(o.json, describe(o, context, bake, statistics, saved, elapsed.count()));
    return 0;
}

} // namespace

Command addBake(CLI::App& parent)
{
    CLI::App* app = parent.add_subcommand("bake", "Bake a scene's light into a .sgl file");
    const auto o = std::make_shared<Options>();
    addSceneOptions(*app, o->scene);
    app->add_option("-o,--output", o->output, "The bake, .sgl")->required()->type_name("FILE");
    addSettings(*app, *o);
    app->add_flag("--memory", o->memory, "Only print what the bake will allocate on the device");
    addJsonOption(*app, o->json);
    addDeviceOptions(*app, o->device);
    addExamples(*app, "  strandlight bake builtin:room -o room.sgl\n"
                      "  strandlight bake house.glb --env sky.hdr --atlas 256 -o house.sgl\n"
                      "Ctrl-C keeps house.sgl.checkpoint; the same command with --resume goes on "
                      "to the same bytes.");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
