// Direct light of punctual lights.
#pragma once

#include <glm/glm.hpp>

#include "engine/graph/render_graph.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "passes/gbuffer.hpp"

namespace strandlight {

// Adds point, spot and directional lights with one shadow ray each to `lit`; returns its next
// version. The scene must have punctual lights.
ImageId addPunctualPass(RenderGraph& graph, GpuScene& scene, const GBufferIds& gbuffer,
                        glm::vec3 eye, ImageId lit);

} // namespace strandlight
