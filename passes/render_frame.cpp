#include "passes/render_frame.hpp"

#include <initializer_list>
#include <optional>
#include <utility>

#include "engine/base/error.hpp"
#include "engine/graph/plan.hpp"
#include "engine/scene/environment.hpp"
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
    bool punctual = false;
    bool environmentDiffuse = false;
    bool environmentSpecular = false;
    bool sky = false;
    bool emission = false;
    bool inspect = false; // lobes or atlas

    bool anySpecular() const { return specular || environmentSpecular; }
    bool anyEnvironment() const { return environmentDiffuse || environmentSpecular || sky; }
};

FramePlan planFrame(const Scene& scene, const GpuScene& gpuScene, const SgTextures& textures,
                    RenderView view, std::vector<std::string>& skipped)
{
    const bool final = view == RenderView::Final;
    const bool diffuseView = final || view == RenderView::Diffuse;
    const bool specularView = final || view == RenderView::Specular;
    FramePlan plan;
    plan.inspect = view >= RenderView::Lobes;
    plan.emission = final;
    const auto need = [&](bool& slot, bool viewPart, const char* what,
                          std::initializer_list<std::pair<bool, const char*>> sceneParts) {
        for (const auto& [there, reason] : sceneParts)
            if (!there) {
                skipped.push_back(std::string(what) + ": " + reason);
                return;
            }
        slot = viewPart;
        if (!viewPart)
            skipped.push_back(std::string(what) + ": not in this view");
    };
    const std::pair<bool, const char*> layer{gpuScene.has(gpu::kFeatureLayer),
                                             "no surface has a specular layer"};
    const std::pair<bool, const char*> lit{textures.radiance.lobes.valid(),
                                           "no texel keeps a lobe"};
    const std::pair<bool, const char*> seen{textures.environment.lobes.valid(),
                                            "no texel sees the environment"};
    need(plan.diffuse, diffuseView, "diffuse", {lit});
    need(plan.specular, specularView, "specular", {layer, lit});
    need(plan.punctual, final, "punctual lights",
         {{gpuScene.lightCount > 0, "the scene has none"}});
    if (!scene.environment) {
        skipped.push_back("environment: the scene has none");
        return plan;
    }
    need(plan.environmentDiffuse, diffuseView, "environment diffuse", {seen});
    need(plan.environmentSpecular, specularView, "environment specular", {layer, seen});
    need(plan.sky, final, "sky", {});
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
    const glm::vec3 eye = camera.eye;
    const auto lobesOf = [&](SgLobeBuffers& lobes) {
        return importLobes(graph, lobes, textures.resolution);
    };
    const std::uint32_t view = std::uint32_t(settings.view);
    if (plan.inspect)
        return addSgViewPass(graph, gbuffer, lobesOf(textures.radiance), eye, view, lit);
    const ImageId tableId = plan.anySpecular() ? graph.importImage(table) : ImageId{};
    if (plan.diffuse || plan.specular) {
        const SgLobeIds radiance = lobesOf(textures.radiance);
        if (plan.diffuse)
            lit = addSgDiffusePass(graph, "sg diffuse", gbuffer, radiance, eye, settings.diffuse,
                                   lit);
        if (plan.specular)
            lit = addSgSpecularPass(graph, gbuffer, radiance, tableId, eye, settings.specular, lit);
    }
    if (plan.punctual)
        lit = addPunctualPass(graph, gpuScene, gbuffer, eye, lit);
    if (!plan.anyEnvironment())
        return lit;
    EnvironmentIds environment = addEnvironment(graph, *scene.environment);
    if (plan.environmentDiffuse || plan.environmentSpecular) {
        const SgLobeIds seen = lobesOf(textures.environment);
        if (plan.environmentDiffuse)
            lit = addSgDiffusePass(graph, "sg diffuse environment", gbuffer, seen, eye,
                                   settings.diffuse, lit);
        if (plan.environmentSpecular) {
            environment = addEnvironmentPrefilterPass(graph, environment);
            lit = addSgEnvironmentPass(graph, gbuffer, seen, tableId, environment, eye,
                                       settings.specular, lit);
        }
    }
    if (plan.sky) {
        const glm::uvec3 extent = graph.extent(lit);
        lit = addSkyPass(graph, gbuffer.position, environment,
                         cameraRays(camera, extent.x, extent.y), lit);
    }
    return lit;
}

// The sky, where there is nothing else to see.
FrameResult renderSky(const Scene& scene, const Camera& camera, const RenderSettings& settings)
{
    FrameResult result;
    result.radiance = CpuImage(settings.width, settings.height, glm::vec4(0, 0, 0, 1));
    result.skipped.push_back("surfaces and their light: the scene has no triangles");
    if (!scene.environment) {
        result.skipped.push_back("environment: the scene has none");
        return result;
    }
    if (settings.view != RenderView::Final) {
        result.skipped.push_back("sky: not in this view");
        return result;
    }
    const std::uint32_t factor = settings.supersample;
    const gpu::CameraRays rays =
        cameraRays(camera, settings.width * factor, settings.height * factor);
    for (std::uint32_t y = 0; y < settings.height * factor; ++y)
        for (std::uint32_t x = 0; x < settings.width * factor; ++x)
            result.radiance.at(x / factor, y / factor) +=
                glm::vec4(
                    environmentRadiance(*scene.environment,
                                        gpu::cameraRayDirection(rays, glm::vec2(x, y) + 0.5f)),
                    0.0f) /
                float(factor * factor);
    return result;
}

} // namespace

FrameResult renderFrame(Context& context, const Scene& scene, GpuScene& gpuScene,
                        const SgBake& bake, const Camera& camera, const RenderSettings& settings)
{
    checkInputs(scene, bake, settings);
    if (scene.triangles.empty())
        return renderSky(scene, camera, settings);
    FrameResult result;
    SgTextures textures = uploadSgTextures(context, bake);
    const FramePlan plan = planFrame(scene, gpuScene, textures, settings.view, result.skipped);
    Image table = plan.anySpecular() ? uploadSpecularTable(context) : Image();
    result.textureBytes = textures.radiance.bytes() + textures.environment.bytes();

    RenderGraph graph(context);
    graph.setTimings(Timings::Passes); // the record of what ran
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
    const GraphPlan& memory = graph.compile();
    result.targetBytes = memory.transientBytes;
    result.arenaBytes = memory.arenaBytes;
    graph.run();

    result.radiance = graph.read(picture);
    result.timings = graph.timings();
    for (const PassTiming& timing : result.timings)
        result.passes.push_back(timing.pass);
    return result;
}

} // namespace strandlight
