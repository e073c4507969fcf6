#include "engine/scene/gpu_scene.hpp"

#include <algorithm>

#include "engine/scene/emitters.hpp"
#include "shaders/shared/octahedral.h"

namespace strandlight {
namespace {

std::uint32_t packDirection(glm::vec3 direction)
{
    const float squared = glm::dot(direction, direction);
    if (!(squared > 0.0f))
        direction = glm::vec3(0.0f, 0.0f, 1.0f);
    return glm::packSnorm2x16(gpu::octEncode(glm::normalize(direction)) * 2.0f - 1.0f);
}

std::uint32_t packTangent(glm::vec4 tangent)
{
    return (packDirection(glm::vec3(tangent)) & ~1u) | (tangent.w < 0.0f ? 1u : 0u);
}

std::vector<glm::uvec4> packCorners(const Scene& scene, const Bvh& bvh, bool texCoord1)
{
    std::vector<glm::uvec4> corners;
    for (const std::uint32_t triangle : bvh.order)
        for (int k = 0; k < 3; ++k) {
            const Vertex& v = scene.vertices[scene.triangles[triangle][k]];
            corners.push_back(glm::uvec4(packDirection(v.normal), glm::floatBitsToUint(v.uv0),
                                         packTangent(v.tangent)));
        }
    for (std::size_t i = 0; texCoord1 && i < bvh.order.size(); ++i) {
        const glm::uvec3 t = scene.triangles[bvh.order[i]];
        corners.push_back(glm::uvec4(glm::floatBitsToUint(scene.vertices[t.x].uv1),
                                     glm::floatBitsToUint(scene.vertices[t.y].uv1)));
        corners.push_back(glm::uvec4(glm::floatBitsToUint(scene.vertices[t.z].uv1), 0u, 0u));
    }
    return corners;
}

std::vector<glm::uvec4> packLightTable(const Scene& scene, const EmitterTable& emitters,
                                       const EnvironmentGrid& grid)
{
    float environmentProbability = 0.0f;
    glm::uvec2 size(0u);
    if (scene.environment) {
        environmentProbability = emitters.entries.empty() ? 1.0f : 0.5f;
        size = {scene.environment->latLong.width, scene.environment->latLong.height};
    }
    std::vector<glm::uvec4> table{glm::uvec4(std::uint32_t(emitters.entries.size()),
                                             glm::floatBitsToUint(environmentProbability),
                                             grid.width, grid.height),
                                  glm::uvec4(size, 0u, 0u)};
    table.insert(table.end(), emitters.entries.begin(), emitters.entries.end());
    return table;
}

} // namespace

std::uint32_t sceneFeatures(const Scene& scene)
{
    std::uint32_t features = 0;
    std::vector<bool> used(scene.materials.size(), false);
    for (const std::uint32_t material : scene.triangleMaterials)
        used[material] = true;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (!used[i])
            continue;
        const Material& m = scene.materials[i];
        const auto slot = [&](const TextureSlot& s, std::uint32_t feature) {
            if (s.texture < 0)
                return;
            features |= feature;
            if (s.texCoord == 1)
                features |= gpu::kFeatureTexCoord1;
        };
        slot(m.baseColorTexture, gpu::kFeatureBaseColorTexture);
        slot(m.metallicRoughnessTexture, gpu::kFeatureMetallicRoughnessTexture);
        slot(m.normalTexture, gpu::kFeatureNormalTexture);
        slot(m.emissiveTexture, gpu::kFeatureEmissiveTexture);
        if (m.alphaCutoff >= 0.0f)
            features |= gpu::kFeatureAlphaMask;
        if (m.specular > 0.0f || m.metallic > 0.0f)
            features |= gpu::kFeatureLayer;
    }
    if (!scene.lights.empty())
        features |= gpu::kFeaturePunctual;
    if (scene.environment)
        features |= gpu::kFeatureEnvironment;
    return features;
}

TracedScene prepareScene(const Scene& scene)
{
    TracedScene traced;
    traced.features = sceneFeatures(scene);
    traced.bvh = buildBvh(scene);
    traced.textures = packTextures(scene);
    traced.materials = packMaterials(scene);
    traced.lights = packLights(scene);
    traced.corners =
        packCorners(scene, traced.bvh, (traced.features & gpu::kFeatureTexCoord1) != 0u);

    const EmitterTable emitters = buildEmitterTable(scene, traced.bvh, traced.textures);
    if (!emitters.entries.empty())
        traced.features |= gpu::kFeatureEmitters;
    for (std::size_t slot = 0; slot < emitters.triangleDensity.size(); ++slot)
        traced.bvh.triangles[slot * 3 + 2].w = glm::floatBitsToUint(emitters.triangleDensity[slot]);

    EnvironmentGrid grid;
    if (scene.environment) {
        grid = buildEnvironmentGrid(*scene.environment);
        traced.environment = scene.environment->latLong.pixels;
        traced.environment.insert(traced.environment.end(), grid.cells.begin(), grid.cells.end());
    }
    traced.lightTable = packLightTable(scene, emitters, grid);
    return traced;
}

std::uint32_t GpuScene::bufferCount() const
{
    std::uint32_t count = 0;
    for (const Buffer* buffer :
         {&nodes, &triangles, &corners, &materials, &lightTable, &textures, &lights, &environment})
        count += buffer->valid() ? 1u : 0u;
    return count;
}

GpuScene uploadScene(Context& context, const Scene& scene)
{
    const TracedScene traced = prepareScene(scene);
    GpuScene device;
    device.grid = traced.bvh.grid;
    device.features = traced.features;
    device.triangleCount = std::uint32_t(traced.bvh.order.size());
    device.lightCount = std::uint32_t(traced.lights.size());
    device.nodes = Buffer::from(context, traced.bvh.nodes, "scene nodes");
    device.triangles = Buffer::from(context, traced.bvh.triangles, "scene triangles");
    device.corners = Buffer::from(context, traced.corners, "scene corners");
    device.materials = Buffer::from(context, traced.materials, "scene materials");
    device.lightTable = Buffer::from(context, traced.lightTable, "scene light table");
    if (!traced.textures.words.empty())
        device.textures = Buffer::from(context, traced.textures.words, "scene textures");
    if (!traced.lights.empty())
        device.lights = Buffer::from(context, traced.lights, "scene lights");
    if (!traced.environment.empty())
        device.environment = Buffer::from(context, traced.environment, "scene environment");
    return device;
}

} // namespace strandlight
