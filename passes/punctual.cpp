#include "passes/punctual.hpp"

#include <algorithm>

#include "engine/base/assert.hpp"
#include "kernels/sg.gen.hpp"
#include "shaders/shared/punctual_types.h"

namespace strandlight {

ImageId addPunctualPass(RenderGraph& graph, GpuScene& scene, const GBufferIds& gbuffer,
                        glm::vec3 eye, ImageId lit)
{
    STRANDLIGHT_ASSERT(scene.lightCount > 0 && scene.lights.valid());
    PassBuilder pass = graph.addComputePass("punctual lights");
    for (const ImageId image :
         {gbuffer.position, gbuffer.normal, gbuffer.diffuse, gbuffer.specular})
        pass.read(image);
    const BufferId nodes = pass.read(graph.importBuffer(scene.nodes));
    const BufferId triangles = pass.read(graph.importBuffer(scene.triangles));
    const BufferId corners = pass.read(graph.importBuffer(scene.corners));
    const BufferId materials = pass.read(graph.importBuffer(scene.materials));
    const BufferId words =
        scene.textures.valid() ? pass.read(graph.importBuffer(scene.textures)) : materials;
    const BufferId lights = pass.read(graph.importBuffer(scene.lights));
    const ImageId out = pass.write(lit);
    const glm::uvec3 extent = graph.extent(out);
    gpu::PunctualPush push{scene.grid, eye, extent.x, extent.y, scene.triangleCount, 0, 0};
    for (; push.firstLight < scene.lightCount; push.firstLight += push.lightCount) {
        push.lightCount =
            std::min(scene.lightCount - push.firstLight, gpu::kPunctualLightsPerDispatch);
        pass.dispatch(kernels::punctual, extent, push,
                      {gbuffer.position, gbuffer.normal, gbuffer.diffuse, gbuffer.specular, nodes,
                       triangles, corners, materials, words, lights, out},
                      {scene.has(gpu::kFeatureAlphaMask) ? 1u : 0u,
                       scene.has(gpu::kFeatureTexCoord1) ? 1u : 0u});
    }
    return out;
}

} // namespace strandlight
