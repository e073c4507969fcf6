// From a bake to a picture, in one call.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/image.hpp"
#include "engine/graph/render_graph.hpp"
#include "engine/scene/camera.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "passes/sg_field.hpp"
#include "passes/sg_shade.hpp"

namespace strandlight {

enum class RenderView : std::uint32_t
{
    Final = gpu::kViewFinal,
    Diffuse = gpu::kViewDiffuse,   // diffuse reflection alone
    Specular = gpu::kViewSpecular, // glossy reflection alone
    Lobes = gpu::kViewLobes,       // the light field in a perfect mirror
    Atlas = gpu::kViewAtlas,       // the atlas's texels
    Count = gpu::kViewCount        // lobes of the radiance that shading loops over, a number
};

struct RenderSettings
{
    std::uint32_t width = 640;
    std::uint32_t height = 480;
    std::uint32_t supersample = 2; // per axis, 1 .. 8; averaged in linear radiance
    SpecularModel specular = SpecularModel::Mixture;
    DiffuseModel diffuse = DiffuseModel::Tokuyoshi;
    RenderView view = RenderView::Final;
};

struct FrameResult
{
    CpuImage radiance;               // linear, [height, width]
    std::vector<std::string> passes; // that ran, in order
    std::vector<std::string>
        skipped; // what the scene did not need, and why: "environment: the scene has none"
    std::vector<PassTiming> timings; // of those passes, GPU milliseconds
    std::uint64_t textureBytes = 0;  // of the baked lobes on the device
    std::uint64_t targetBytes = 0;   // of pictures between passes, if each had its own memory
    std::uint64_t arenaBytes = 0;    // that they take, sharing it
};

// The scene on the device must be this scene; of a scene without triangles it may be empty: its
// picture is the sky, made without the device. Throws Error when the bake belongs to another
// geometry (triangle counts differ), the size is empty or over 16384, or the scene has an
// environment and the bake has none.
FrameResult renderFrame(Context& context, const Scene& scene, GpuScene& gpuScene,
                        const SgBake& bake, const Camera& camera,
                        const RenderSettings& settings = {});

} // namespace strandlight
