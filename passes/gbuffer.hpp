// What the camera sees, as images: raster of triangle indices, then a compute pass that turns them
// into surfaces.
#pragma once

#include <cstdint>

#include "engine/graph/render_graph.hpp"
#include "engine/scene/camera.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "passes/sg_textures.hpp"

namespace strandlight {

struct GBufferSettings
{
    std::uint32_t width = 0; // of the render, supersampling included
    std::uint32_t height = 0;
    DepthRange depthRange; // cameraDepthRange()
    bool emission = true;  // write emitted radiance; false leaves `emissive` black
};

// RGBA32F images of the render size; what their channels hold is in shaders/shared/shade_types.h.
struct GBufferIds
{
    ImageId position;
    ImageId frame;
    ImageId tangent;
    ImageId normal;
    ImageId diffuse;
    ImageId specular;
    ImageId emissive; // the picture's first light: shading passes add to it
};

// Throws Error when the size is 0 or the camera degenerate.
GBufferIds addGBufferPass(RenderGraph& graph, GpuScene& scene, SgTextures& textures,
                          const Camera& camera, const GBufferSettings& settings);

} // namespace strandlight
