#include "passes/skip_study.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>

#include "engine/scene/grooms.hpp"
#include "engine/scene/procedural.hpp"
#include "passes/bake.hpp"
#include "passes/hair_render.hpp"
#include "passes/render_frame.hpp"

namespace strandlight {
namespace {

struct SkipCase
{
    std::string name;
    Scene scene;
    HairStrands hair;
    std::vector<std::string> unneeded; // parts of names of passes
};

Scene fullScene()
{
    Scene scene = buildRoomScene();
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> materials;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const glm::uvec3 t = scene.triangles[i];
        const float height =
            std::min({scene.vertices[t.x].position.y, scene.vertices[t.y].position.y,
                      scene.vertices[t.z].position.y});
        if (height > 2.99f) // the ceiling
            continue;
        triangles.push_back(t);
        materials.push_back(scene.triangleMaterials[i]);
    }
    scene.triangles = std::move(triangles);
    scene.triangleMaterials = std::move(materials);
    scene.lights = {PunctualLight{.position = {0.0f, 2.5f, 0.5f}}};
    scene.environment = Environment{CpuImage(16, 8, glm::vec4(1.0f))};
    return scene;
}

std::vector<SkipCase> makeCases(std::uint32_t strands)
{
    GroomSettings groom = groomSettings("short");
    groom.strands = strands;
    const SkipCase full{"full", fullScene(), makeGroom("short", groom), {}};
    std::vector<SkipCase> cases{full};
    const auto add = [&](const char* name, std::vector<std::string> unneeded,
                         const std::function<void(SkipCase&)>& take) {
        cases.push_back(full);
        cases.back().name = name;
        cases.back().unneeded = std::move(unneeded);
        take(cases.back());
    };
    add("without environment", {"environment", "sky"},
        [](SkipCase& c) { c.scene.environment.reset(); });
    add("without hair", {"hair"}, [](SkipCase& c) { c.hair = {}; });
    add("without lamp", {"punctual"}, [](SkipCase& c) { c.scene.lights.clear(); });
    add("without metal or gloss", {"specular", "prefilter", "sg environment"}, [](SkipCase& c) {
        for (Material& material : c.scene.materials)
            material.metallic = material.specular = 0.0f;
    });
    add("furnace", {"environment", "sky", "hair", "punctual", "specular"}, [](SkipCase& c) {
        c.scene = buildFurnaceScene(0.5f);
        c.hair = {};
    });
    add("without light", {"sg ", "environment", "sky", "hair", "punctual"}, [](SkipCase& c) {
        c.scene = buildDarkBoxScene();
        c.hair = {};
    });
    add("empty", {""}, [](SkipCase& c) {
        c.scene = buildEmptyScene();
        c.hair = {};
    });
    return cases;
}

struct DrawnFrame
{
    std::vector<PassTiming> timings;
    std::size_t skipped = 0;
};

DrawnFrame drawFrame(Context& context, const SkipCase& c, GpuScene& device, const SgBake& bake,
                     const SkipSettings& settings)
{
    const Camera camera = defaultCamera(c.scene);
    const FrameResult frame = renderFrame(context, c.scene, device, bake, camera,
                                          {.width = settings.width, .height = settings.height});
    HairRenderSettings over;
    over.width = settings.width;
    over.height = settings.height;
    over.background = &frame.radiance;
    const HairFrame hair = renderHair(context, c.hair, &c.scene, camera, over);
    DrawnFrame drawn{frame.timings, frame.skipped.size() + hair.skipped.size()};
    drawn.timings.insert(drawn.timings.end(), hair.timings.begin(), hair.timings.end());
    return drawn;
}

// One bake and one frame, by their counters.
void check(const SkipCase& c, const SgBake& bake, const BakeStatistics& statistics,
           const DrawnFrame& frame, SkipRow& row)
{
    row.captureDispatches = statistics.captureDispatches;
    row.lobes = bake.radiance.keptCount();
    row.environmentLobes = bake.environment ? bake.environment->keptCount() : 0;
    row.skipped = statistics.skipped.size() + frame.skipped;
    for (const PassTiming& timing : frame.timings) {
        row.passes.push_back(timing.pass);
        if (std::any_of(c.unneeded.begin(), c.unneeded.end(), [&](const std::string& part) {
                return timing.pass.find(part) != std::string::npos;
            }))
            row.wrong.push_back(timing.pass);
    }
    if (!sendsLight(c.scene) && statistics.captureDispatches > 0)
        row.wrong.push_back("capture");
    if (!c.scene.environment && row.environmentLobes > 0)
        row.wrong.push_back("fit of the environment");
}

SkipRow measureCase(const ContextSettings& settings, const SkipCase& c, const SkipSettings& s)
{
    Context context = Context::headless(settings);
    SkipRow row{.name = c.name};
    BakeSettings wanted;
    wanted.atlasResolution = s.atlas;
    wanted.lightfieldSize = 8;
    wanted.samplesPerDirection = s.samples;
    wanted.steps = s.steps;
    BakeStatistics statistics;
    SgBake bake = bakeScene(context, c.scene, wanted, &statistics);
    GpuScene device = c.scene.triangles.empty() ? GpuScene() : uploadScene(context, c.scene);
    check(c, bake, statistics, drawFrame(context, c, device, bake, s), row);
    row.pipelines = context.pipelinesCreated();
    if (!row.wrong.empty())
        return row;

    row.bakeSeconds = row.frameMilliseconds = HUGE_VAL;
    for (std::uint32_t i = 0; i < s.repeats; ++i) {
        const auto start = std::chrono::steady_clock::now();
        bake = bakeScene(context, c.scene, wanted);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        row.bakeSeconds = std::min(row.bakeSeconds, seconds.count());
    }
    for (std::uint32_t i = 0; i < s.repeats; ++i) {
        double milliseconds = 0.0;
        for (const PassTiming& timing : drawFrame(context, c, device, bake, s).timings)
            milliseconds += timing.milliseconds;
        row.frameMilliseconds = std::min(row.frameMilliseconds, milliseconds);
    }
    row.peakBytes = context.peakBytesAllocated();
    return row;
}

} // namespace

std::vector<SkipRow> studySkips(const ContextSettings& device, const SkipSettings& settings)
{
    std::vector<SkipRow> rows;
    for (const SkipCase& c : makeCases(settings.strands))
        rows.push_back(measureCase(device, c, settings));
    return rows;
}

} // namespace strandlight
