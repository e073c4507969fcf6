// A scene on the device: the hierarchy, shading attributes, materials, textures and lights.
// What a scene has not is not created; bind `orDummy` in its place.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/bvh.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/texture_pool.hpp"
#include "engine/vk/buffer.hpp"
#include "engine/vk/context.hpp"
#include "shaders/shared/light_types.h"

namespace strandlight {

struct GpuScene
{
    gpu::BvhGrid grid{}; // for push constants
    std::uint32_t features =
        0; // kFeature... bits, specialisation constant 0 of the tracing kernels
    std::uint32_t triangleCount = 0;
    std::uint32_t lightCount = 0; // punctual

    Buffer nodes;       // uvec4 [8, nodeCount] (trace_types.h)
    Buffer triangles;   // uvec4 [triangle, 3], leaf order; word 3 of the first is the scene's
                        // triangle index
    Buffer corners;     // uvec4 [triangle, 3] (light_types.h)
    Buffer materials;   // GpuMaterial [materials] (scene_types.h)
    Buffer lightTable;  // uvec4 (light_types.h)
    Buffer textures;    // words of the texture pool; only with textures
    Buffer lights;      // GpuLight [lights]; only with punctual lights
    Buffer environment; // vec4 [height, width] radiance, then the grid's cells; only with an
                        // environment

    bool has(std::uint32_t feature) const { return (features & feature) != 0u; }
    // A binding cannot stay empty: the material buffer stands in for what the kernel will not read.
    Buffer& orDummy(Buffer& buffer) { return buffer.valid() ? buffer : materials; }
    std::uint32_t bufferCount() const; // buffers that exist; shows what was skipped
};

// Builds the hierarchy and uploads everything. Throws Error for unusable positions (buildBvh).
GpuScene uploadScene(Context& context, const Scene& scene);

// Parts of uploadScene that the CPU twin shares.
std::uint32_t sceneFeatures(const Scene& scene);
// With the emitter densities in place.
struct TracedScene
{
    Bvh bvh;
    std::vector<glm::uvec4> corners;
    std::vector<glm::uvec4> lightTable;
    std::vector<glm::vec4> environment; // empty without one
    std::vector<gpu::GpuMaterial> materials;
    std::vector<gpu::GpuLight> lights;
    TexturePool textures;
    std::uint32_t features = 0;
};
TracedScene prepareScene(const Scene& scene);

} // namespace strandlight
