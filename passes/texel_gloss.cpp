#include "passes/texel_gloss.hpp"

#include <algorithm>

#include "engine/scene/texture_pool.hpp"
#include "shaders/shared/brdf.h"

namespace strandlight {

std::vector<float> texelGloss(const Scene& scene, const Atlas& atlas)
{
    const std::vector<gpu::GpuMaterial> materials = packMaterials(scene);
    const TexturePool textures = packTextures(scene);
    std::vector<float> gloss;
    gloss.reserve(atlas.texels.size());
    for (const AtlasTexel& texel : atlas.texels) {
        const glm::uvec3 t = scene.triangles[texel.triangle];
        const Vertex &a = scene.vertices[t.x], &b = scene.vertices[t.y], &c = scene.vertices[t.z];
        const glm::vec2 w = texel.barycentric;
        const auto blend = [&](glm::vec2 p, glm::vec2 q, glm::vec2 r) {
            return (1.0f - w.x - w.y) * p + w.x * q + w.y * r;
        };
        const SurfaceMaterial m = evaluateMaterial(
            textures, materials[scene.triangleMaterials[texel.triangle]],
            blend(a.uv0, b.uv0, c.uv0), blend(a.uv1, b.uv1, c.uv1), kFullResolution);
        const gpu::Surface surface =
            gpu::makeSurface(m.baseColor, m.metallic, m.roughness, m.specular, m.specularColor);
        const float brightest = std::max({surface.f0.x, surface.f0.y, surface.f0.z});
        gloss.push_back(brightest * (1.0f - std::clamp(m.roughness, 0.0f, 1.0f)));
    }
    return gloss;
}

} // namespace strandlight
