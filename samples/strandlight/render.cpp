// strandlight render: a picture from a bake.
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "passes/render_frame.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/open_bake.hpp"
#include "samples/strandlight/outputs.hpp"
#include "samples/strandlight/savings_text.hpp"

namespace strandlight::cli {

namespace {

const std::map<std::string, RenderView> kViews{
    {"final", RenderView::Final},       {"diffuse", RenderView::Diffuse},
    {"specular", RenderView::Specular}, {"lobes", RenderView::Lobes},
    {"atlas", RenderView::Atlas},       {"count", RenderView::Count}};
const std::map<std::string, SpecularModel> kSpecularModels{{"mixture", SpecularModel::Mixture},
                                                           {"asg", SpecularModel::Asg},
                                                           {"ndf", SpecularModel::NdfFilter}};
const std::map<std::string, DiffuseModel> kDiffuseModels{{"tokuyoshi", DiffuseModel::Tokuyoshi},
                                                         {"hill", DiffuseModel::Hill},
                                                         {"wang", DiffuseModel::Wang}};

struct Options
{
    DeviceOptions device;
    SceneOptions scene;
    ViewOptions view;
    RenderSettings settings;
    std::string bake;
    std::string viewName = "final";
    std::string specularName = "mixture";
    std::string diffuseName = "tokuyoshi";
    bool stats = false;
    std::string json;
};

// What --stats draws beside the picture.
struct FrameStats
{
    double allLobesMilliseconds = 0.0; // of the same frame with nothing dropped
    std::uint64_t trips = 0;           // turns of a shading pass's loop over lobes, all pixels
    std::uint64_t allTrips = 0;        // with nothing dropped
};

double totalMilliseconds(const FrameResult& frame)
{
    double total = 0.0;
    for (const PassTiming& timing : frame.timings)
        total += timing.milliseconds;
    return total;
}

std::uint64_t tripsOf(const FrameResult& counts, std::uint32_t supersample)
{
    double sum = 0.0;
    for (const glm::vec4& pixel : counts.radiance.pixels)
        sum += double(pixel.x) * supersample * supersample;
    return std::uint64_t(std::llround(sum));
}

Json describe(const Options& o, const Context& context, const Camera& camera, const SgBake& bake,
              const FrameResult& frame, const FrameStats& stats, double seconds)
{
    Json json = describeRun("render", &context);
    json["settings"] = {{"scene", o.scene.scene},
                        {"environment", o.scene.environment},
                        {"bake", o.bake},
                        {"width", o.settings.width},
                        {"height", o.settings.height},
                        {"supersample", o.settings.supersample},
                        {"camera", describeCamera(camera)},
                        {"view", o.viewName},
                        {"specular", o.specularName},
                        {"diffuse", o.diffuseName},
                        {"exposure", o.view.exposure}};
    Json passes = Json::array();
    for (const PassTiming& timing : frame.timings)
        passes.push_back({{"name", timing.pass}, {"milliseconds", timing.milliseconds}});
    json["result"] = {{"files", o.view.outputs},
                      {"passes", passes},
                      {"skipped", frame.skipped},
                      {"milliseconds", totalMilliseconds(frame)},
                      {"frames", o.stats ? 2 : 1}, // times are of the last
                      {"lobe_bytes", frame.textureBytes},
                      {"target_bytes", frame.targetBytes},
                      {"arena_bytes", frame.arenaBytes},
                      {"savings", describeSavings(bakeSavings(bake), kDeviceLobeBytes)},
                      {"milliseconds_with_all_lobes", stats.allLobesMilliseconds},
                      {"lobe_trips", stats.trips},
                      {"lobe_trips_with_all_lobes", stats.allTrips},
                      {"peak_device_bytes", context.peakBytesAllocated()},
                      {"seconds", seconds}};
    return json;
}

void printStats(const Context& context, const SgBake& bake, const FrameResult& frame,
                const FrameStats& stats)
{
    std::printf("device    %s\n", context.device().name.c_str());
    for (const PassTiming& timing : frame.timings)
        std::printf("pass      %-24s %9.3f ms\n", timing.pass.c_str(), timing.milliseconds);
    for (const std::string& pass : frame.skipped)
        std::printf("culled    %s\n", pass.c_str());
    std::printf("together  %zu passes, %.3f ms; lobes %s, device memory %s\n", frame.passes.size(),
                totalMilliseconds(frame), bytesText(frame.textureBytes).c_str(),
                bytesText(context.peakBytesAllocated()).c_str());
    std::printf("skipped   %zu kinds of light or of passes\n", frame.skipped.size());
    printSavings(bakeSavings(bake), kDeviceLobeBytes);
    printSharing(frame);
    if (stats.allTrips > 0)
        std::printf("saved     %" PRIu64 " of %" PRIu64
                    " turns of a pass's loop over lobes, %.3f ms\n",
                    stats.allTrips - stats.trips, stats.allTrips,
                    stats.allLobesMilliseconds - totalMilliseconds(frame));
}

int run(Options& o)
{
    const auto start = std::chrono::steady_clock::now();
    for (const std::string& output : o.view.outputs)
        requireOutput(output, {".png", ".exr"});
    requireOutput(o.json, {".json"});
    const Size size = parseSize(o.view.size);
    o.settings.width = size.width;
    o.settings.height = size.height;
    o.settings.view = kViews.at(o.viewName);
    o.settings.specular = kSpecularModels.at(o.specularName);
    o.settings.diffuse = kDiffuseModels.at(o.diffuseName);
    const Scene scene = openScene(o.scene);
    const SgBake bake = openBake(o.bake, scene);
    const Camera camera = chooseCamera(scene, o.view.camera);
    Context context = openDevice(o.device);

    GpuScene gpuScene = scene.triangles.empty() ? GpuScene() : uploadScene(context, scene);
    const auto draw = [&](const SgBake& lit, RenderView view) {
        RenderSettings wanted = o.settings;
        wanted.view = view;
        return renderFrame(context, scene, gpuScene, lit, camera, wanted);
    };
    FrameResult frame = draw(bake, o.settings.view);
    FrameStats stats;
    if (o.stats) { // drivers compile at first use: the second frame's times are a frame's
        frame = draw(bake, o.settings.view);
        stats.allLobesMilliseconds = totalMilliseconds(frame);
    }
    if (o.stats && bakeSavings(bake).tiles > 0) {
        const SgBake whole = withAllLobes(bake);
        stats.allLobesMilliseconds = totalMilliseconds(draw(whole, o.settings.view));
        stats.trips = tripsOf(draw(bake, RenderView::Count), o.settings.supersample);
        stats.allTrips = tripsOf(draw(whole, RenderView::Count), o.settings.supersample);
    }
    throwIfInterrupted();
    for (const std::string& output : o.view.outputs)
        writePicture(output, frame.radiance, o.view.exposure);

    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    if (o.stats)
        printStats(context, bake, frame, stats);
    for (const std::string& output : o.view.outputs)
        std::printf("wrote     %s, %.1f s\n", output.c_str(), elapsed.count());
    writeJson(o.json, describe(o, context, camera, bake, frame, stats, elapsed.count()));
    return 0;
}

} // namespace

Command addRender(CLI::App& parent)
{
    CLI::App* app = parent.add_subcommand("render", "Render a scene from its bake");
    const auto o = std::make_shared<Options>();
    addSceneOptions(*app, o->scene);
    app->add_option("--bake", o->bake, "The bake, .sgl")->required()->type_name("FILE");
    addViewOptions(*app, o->view);
    app->add_option("--view", o->viewName,
                    "final, diffuse, specular, lobes, atlas, or the count of lobes that shade")
        ->type_name("VIEW")
        ->capture_default_str()
        ->check(CLI::IsMember(kViews));
    app->add_option("--specular", o->specularName,
                    "mixture: GGX as four SGs; asg: as in the thesis; ndf: Tokuyoshi 2024")
        ->type_name("MODEL")
        ->capture_default_str()
        ->check(CLI::IsMember(kSpecularModels));
    app->add_option("--diffuse", o->diffuseName,
                    "tokuyoshi: 2024, exact to 1e-3; hill, wang: cheaper")
        ->type_name("MODEL")
        ->capture_default_str()
        ->check(CLI::IsMember(kDiffuseModels));
    app->add_option("--supersample", o->settings.supersample, "Per axis")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(1u, 8u));
    app->add_flag("--stats", o->stats,
                  "Render twice; print passes, milliseconds of the second frame, what was culled, "
                  "skipped and saved");
    addJsonOption(*app, o->json);
    addDeviceOptions(*app, o->device);
    addExamples(*app,
                "  strandlight render builtin:room --bake room.sgl -o room.png --stats\n"
                "  strandlight render house.glb --env sky.hdr --bake house.sgl --view specular "
                "--exposure 1 -o glossy.exr");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
