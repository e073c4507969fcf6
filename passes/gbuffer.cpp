#include "passes/gbuffer.hpp"

#include <string>

#include "engine/base/error.hpp"
#include "kernels/gbuffer.gen.hpp"
#include "shaders/shared/gbuffer_types.h"

namespace strandlight {
namespace {

static_assert(sizeof(gpu::VisibilityPush) == 68 && sizeof(gpu::SurfacesPush) == 64);

// R32UI of slot + 1, nearest surface; alpha masks cost only the scenes that have them.
ImageId addVisibilityPass(RenderGraph& graph, GpuScene& scene, const Camera& camera,
                          const GBufferSettings& settings)
{
    const ImageDesc desc{settings.width, settings.height, 1, Format::R32UI, 1};
    PassBuilder pass = graph.addRasterPass("visibility");
    const BufferId triangles = pass.read(graph.importBuffer(scene.triangles));
    const ImageId visible = pass.color(graph.createImage("visible triangle", desc));
    // Bound by the pass: only its test matters.
    [[maybe_unused]] const ImageId depth =
        pass.depth(graph.createImage("depth", desc.with(Format::Depth32F)));
    const gpu::VisibilityPush push{
        cameraViewProjection(camera, settings.width, settings.height, settings.depthRange),
        scene.triangleCount};
    const std::uint32_t vertices = scene.triangleCount * 3;
    if (!scene.has(gpu::kFeatureAlphaMask)) {
        const RasterDesc raster{.vertex = &kernels::visibility_vert,
                                .fragment = &kernels::visibility_frag};
        pass.draw(raster, vertices, 1, push, {triangles});
        return visible;
    }
    const BufferId corners = pass.read(graph.importBuffer(scene.corners));
    const BufferId materials = pass.read(graph.importBuffer(scene.materials));
    const BufferId words = pass.read(graph.importBuffer(scene.orDummy(scene.textures)));
    const RasterDesc raster{.vertex = &kernels::visibility_masked_vert,
                            .fragment = &kernels::visibility_masked_frag,
                            .constants = {scene.has(gpu::kFeatureTexCoord1) ? 1u : 0u}};
    pass.draw(raster, vertices, 1, push, {triangles, corners, materials, words});
    return visible;
}

} // namespace

GBufferIds addGBufferPass(RenderGraph& graph, GpuScene& scene, SgTextures& textures,
                          const Camera& camera, const GBufferSettings& settings)
{
    if (settings.width == 0 || settings.height == 0)
        throw Error("render size " + std::to_string(settings.width) + "x" +
                    std::to_string(settings.height) + " is empty");
    const ImageId visible = addVisibilityPass(graph, scene, camera, settings);

    PassBuilder pass = graph.addComputePass("surfaces");
    pass.read(visible);
    const BufferId triangles = pass.read(graph.importBuffer(scene.triangles));
    const BufferId corners = pass.read(graph.importBuffer(scene.corners));
    const BufferId materials = pass.read(graph.importBuffer(scene.materials));
    const BufferId words =
        scene.textures.valid() ? pass.read(graph.importBuffer(scene.textures)) : materials;
    const BufferId atlas = pass.read(graph.importBuffer(textures.corners));
    const ImageDesc desc{settings.width, settings.height, 1, Format::RGBA32F, 1};
    const auto target = [&](const char* name) { return pass.write(graph.createImage(name, desc)); };
    GBufferIds ids;
    ids.position = target("position");
    ids.frame = target("frame");
    ids.tangent = target("tangent");
    ids.normal = target("normal");
    ids.diffuse = target("diffuse");
    ids.specular = target("specular");
    ids.emissive = target("emissive");
    const gpu::SurfacesPush push{cameraRays(camera, settings.width, settings.height),
                                 settings.width, settings.height, scene.triangleCount,
                                 settings.emission ? 1.0f : 0.0f};
    pass.dispatch(kernels::gbuffer_surfaces, {settings.width, settings.height, 1}, push,
                  {visible, triangles, corners, materials, words, atlas, ids.position, ids.frame,
                   ids.tangent, ids.normal, ids.diffuse, ids.specular, ids.emissive},
                  {scene.has(gpu::kFeatureTexCoord1) ? 1u : 0u});
    return ids;
}

} // namespace strandlight
