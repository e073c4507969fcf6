#include "passes/render_frame.hpp"

#include <optional>

#include "engine/base/error.hpp"
#include "passes/downsample.hpp"
#include "passes/environment_prefilter.hpp"
#include "passes/gbuffer.hpp"
#include "passes/punctual.hpp"
#include "passes/specular_lut.hpp"

namespace strandlight {
namespace {

// What this scene and view need; the reasons for what they do not go into the result.
struct FramePlan
{
    bool diffuse = false;
    bool specular = false;
    bool environment = false;
    bool punctual = false;
    bool emission = false;
    bool inspect = false; // lobes or atlas
};

FramePlan planFrame(const GpuScene& scene, const SgBake& bake, const RenderSettings& settings,
                    std::vector<std::string>& skipped)
{
    const RenderView view = settings.view;
    const bool lit = view == RenderView::Final;
    FramePlan plan;
    plan.inspect = view == RenderView::Lobes || view == RenderView::Atlas;
    plan.emission = lit;
    const auto need = [&](bool& slot, bool scenePart, bool viewPart, const char* what,
                          const char* reason) {
        slot = scenePart && viewPart;
        if (!slot)
            skipped.push_back(std::string(what) + ": " + (scenePart ? "not in this view" : reason));
    };
    need(plan.diffuse, true, lit || view == RenderView::Diffuse, "diffuse", "");
    need(plan.specular, scene.has(gpu::kFeatureLayer), lit || view == RenderView::Specular,
         "specular", "no surface has a specular layer");
    need(plan.environment, bake.environment.has_value(), !plan.inspect, "environment",
         "the scene has none");
    need(plan.punctual, scene.lightCount > 0, lit, "punctual lights", "the scene has none");
    return plan;
}

void checkInputs(const Scene& scene, const SgBake& bake, const RenderSettings& settings)
{
    const std::uint64_t factor = settings.supersample;
    if (factor < 1 || factor > 8)
        throw Error("supersample is " + std::to_string(factor) + ", it must be 1 to 8");
    if (settings.width == 0 || settings.height == 0 || settings.width * factor > 16384 ||
        settings.height * factor > 16384)
        throw Error("render size " + std::to_string(settings.width) + "x" +
                    std::to_string(settings.height) + " with supersample " +
                    std::to_string(factor) + " is not within 1 to 16384 pixels a side");
    if (bake.atlas.corners.size() != scene.triangles.size() * 3)
        throw Error("the bake is of a scene with " + std::to_string(bake.atlas.corners.size() / 3) +
                    " triangles, this one has " + std::to_string(scene.triangles.size()));
    if (scene.environment && !bake.environment)
        throw Error("the scene has an environment, the bake was made without one");
    if (!scene.environment && bake.environment)
        throw Error("the bake was made with an environment, the scene has none");
}

// The lit passes, in the order in which they add up.
ImageId addLight(RenderGraph& graph, const FramePlan& plan, const Scene& scene, GpuScene& gpuScene,
                 SgTextures& textures, Image& table, const GBufferIds& gbuffer,
                 const Camera& camera, const RenderSettings& settings)
{
    ImageId lit = gbuffer.emissive;
    const SgLobeIds radiance = importRadianceLobes(graph, textures);
    if (plan.inspect)
        return addSgViewPass(graph, gbuffer, radiance, camera.eye, std::uint32_t(settings.view),
                             lit);
    if (plan.diffuse)
        lit = addSgDiffusePass(graph, "sg diffuse", gbuffer, radiance, camera.eye, settings.diffuse,
                               lit);
    const bool needsTable = plan.specular;
    const ImageId tableId = needsTable ? graph.importImage(table) : ImageId{};
    if (plan.specular)
        lit = addSgSpecularPass(graph, gbuffer, radiance, tableId, camera.eye, settings.specular,
                                lit);
    if (plan.punctual)
        lit = addPunctualPass(graph, gpuScene, gbuffer, camera.eye, lit);
    if (!plan.environment)
        return lit;
    const SgLobeIds sky = importEnvironmentLobes(graph, textures);
    EnvironmentIds environment = addEnvironment(graph, *scene.environment);
    if (plan.diffuse)
        lit = addSgDiffusePass(graph, "sg diffuse environment", gbuffer, sky, camera.eye,
                               settings.diffuse, lit);
    if (plan.specular) {
        environment = addEnvironmentPrefilterPass(graph, environment);
        lit = addSgEnvironmentPass(graph, gbuffer, sky, tableId, environment, camera.eye,
                                   settings.specular, lit);
    }
    if (settings.view == RenderView::Final) {
        const glm::uvec3 extent = graph.extent(lit);
        lit = addSkyPass(graph, gbuffer.position, environment,
                         cameraRays(camera, extent.x, extent.y), lit);
    }
    return lit;
}

} // namespace

FrameResult renderFrame(Context& context, const Scene& scene, GpuScene& gpuScene,
                        const SgBake& bake, const Camera& camera, const RenderSettings& settings)
{
    checkInputs(scene, bake, settings);
    FrameResult result;
    const FramePlan plan = planFrame(gpuScene, bake, settings, result.skipped);
    SgTextures textures = uploadSgTextures(context, bake);
    Image table = plan.specular ? uploadSpecularTable(context) : Image();
    result.textureBytes =
        textures.radiance.bytes() + (bake.environment ? textures.environment.bytes() : 0);

    RenderGraph graph(context);
    graph.setTimings(true); // the record of what ran
    const GBufferIds gbuffer = addGBufferPass(graph, gpuScene, textures, camera,
                                              {.width = settings.width * settings.supersample,
                                               .height = settings.height * settings.supersample,
                                               .depthRange = cameraDepthRange(scene, camera),
                                               .emission = plan.emission});
    ImageId picture =
        addLight(graph, plan, scene, gpuScene, textures, table, gbuffer, camera, settings);
    if (settings.supersample > 1)
        picture = addDownsamplePass(graph, picture, settings.supersample);
    graph.output(picture);
    graph.run();

    result.radiance = graph.read(picture);
    result.timings = graph.timings();
    for (const PassTiming& timing : result.timings)
        result.passes.push_back(timing.pass);
    return result;
}

} // namespace strandlight
