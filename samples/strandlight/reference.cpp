// strandlight reference: the truth, path traced.
#include <cstdio>
#include <memory>

#include "passes/path_trace.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

namespace {

struct Options
{
    DeviceOptions device;
    SceneOptions scene;
    ViewOptions view;
    ReferenceSettings settings;
    std::string json;
};

Json describe(const Options& o, const Context& context, const Camera& camera,
              const TraceStatistics& statistics)
{
    const ReferenceSettings& s = o.settings;
    Json json = describeRun("reference", &context);
    json["settings"] = {{"scene", o.scene.scene},
                        {"environment", o.scene.environment},
                        {"width", s.width},
                        {"height", s.height},
                        {"camera", describeCamera(camera)},
                        {"spp", s.samples},
                        {"bounces", s.bounces},
                        {"seed", s.seed},
                        {"exposure", o.view.exposure}};
    json["result"] = {{"files", o.view.outputs},
                      {"seconds", statistics.seconds},
                      {"dispatches", statistics.dispatches},
                      {"slowest_dispatch_ms", statistics.slowestDispatchMs},
                      {"lost_rays", statistics.lostRays},
                      {"rejected_samples", statistics.rejectedSamples}};
    return json;
}

void print(const Options& o, const Context& context, const TraceStatistics& statistics)
{
    const ReferenceSettings& s = o.settings;
    std::printf("device    %s\n", context.device().name.c_str());
    std::printf("paths     %u per pixel, %u bounces, %ux%u pixels\n", s.samples, s.bounces, s.width,
                s.height);
    std::printf("seconds   %.1f in %u dispatches, the slowest %.0f ms\n", statistics.seconds,
                statistics.dispatches, statistics.slowestDispatchMs);
    if (statistics.lostRays + statistics.rejectedSamples > 0)
        std::printf("lost      %llu rays, %llu samples that were not finite\n",
                    static_cast<unsigned long long>(statistics.lostRays),
                    static_cast<unsigned long long>(statistics.rejectedSamples));
    for (const std::string& output : o.view.outputs)
        std::printf("wrote     %s\n", output.c_str());
}

int run(Options& o)
{
    for (const std::string& output : o.view.outputs)
        requireOutput(output, {".png", ".exr"});
    requireOutput(o.json, {".json"});
    const Size size = parseSize(o.view.size);
    o.settings.width = size.width;
    o.settings.height = size.height;
    const Scene scene = openScene(o.scene);
    const Camera camera = chooseCamera(scene, o.view.camera);
    Context context = openDevice(o.device);

    TraceStatistics statistics;
    const CpuImage image = renderReference(context, scene, camera, o.settings, &statistics);
    for (const std::string& output : o.view.outputs)
        writePicture(output, image, o.view.exposure);

    print(o, context, statistics);
    writeJson(o.json, describe(o, context, camera, statistics));
    return 0;
}

} // namespace

Command addReference(CLI::App& parent)
{
    CLI::App* app = parent.add_subcommand("reference", "Path trace the truth");
    const auto o = std::make_shared<Options>();
    addSceneOptions(*app, o->scene);
    addViewOptions(*app, o->view);
    addNumber(*app, "--spp", o->settings.samples, "Paths per pixel", 1u, 1u << 20);
    addNumber(*app, "--bounces", o->settings.bounces, "Reflections on a path", 0u, 64u);
    addNumber(*app, "--seed", o->settings.seed, "Of the random numbers", 0u, 0xffffffffu);
    addJsonOption(*app, o->json);
    addDeviceOptions(*app, o->device);
    addExamples(*app, "  strandlight reference builtin:room -o truth.exr -o truth.png --spp 256\n"
                      "  strandlight reference house.glb --env sky.hdr --camera 0,1.6,2,-3,1,-2,60 "
                      "-o truth.exr");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
