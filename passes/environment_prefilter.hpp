// The distant environment for rendering: radiance pyramid, GGX-prefiltered levels, sky.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/render_graph.hpp"
#include "engine/scene/camera.hpp"
#include "engine/scene/scene.hpp"
#include "shaders/shared/shade_types.h"

namespace strandlight {

struct EnvironmentIds
{
    BufferId pyramid;     // vec4 [levels of shape]
    BufferId prefiltered; // vec4 [kPrefilterLevels, kPrefilterHeight, kPrefilterWidth]; only after
                          // the prefilter pass
    gpu::EnvironmentShape shape{};
};

// All levels, each the solid-angle weighted mean of 2 x 2 texels of the one before. Environments
// too large for a binding of `maximumBytes` are halved first; that is logged.
struct EnvironmentPyramid
{
    std::vector<glm::vec4> texels;
    gpu::EnvironmentShape shape{};
};
EnvironmentPyramid buildEnvironmentPyramid(const Environment& environment,
                                           std::uint64_t maximumBytes = std::uint64_t(96) << 20);

// Uploads the pyramid; enough for the sky.
EnvironmentIds addEnvironment(RenderGraph& graph, const Environment& environment);

// Fills in `prefiltered`: mean radiance over GGX lobes of kPrefilterLevels roughnesses.
// Deterministic.
EnvironmentIds addEnvironmentPrefilterPass(RenderGraph& graph, EnvironmentIds environment);

// Writes the environment where `position` has no surface. `camera`: rays of the picture that `lit`
// is.
ImageId addSkyPass(RenderGraph& graph, ImageId position, const EnvironmentIds& environment,
                   const gpu::CameraRays& camera, ImageId lit);

} // namespace strandlight
