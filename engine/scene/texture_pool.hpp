// All textures of a scene in one array of words, for GPUs without descriptor indexing; materials
// and lights as the shaders read them; and the CPU twin of shaders/lib/textures.glsl.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/scene.hpp"
#include "shaders/shared/scene_types.h"

namespace strandlight {

// words: first kTextureRecordWords per pool texture (scene_types.h), then texels of all levels,
// RGBA8. Pool texture 2 t is Scene texture t read as linear data, 2 t + 1 the same read as sRGB; a
// reading that no material uses has no texels. Mip levels are box-filtered in linear light. Empty
// when no material has a texture.
struct TexturePool
{
    std::vector<std::uint32_t> words;
    std::uint32_t halvings = 0; // how often the largest textures were halved to fit the limit
};

// The limit is the storage range that every Vulkan device has to offer in practice.
inline constexpr std::uint64_t kTexturePoolBytes = std::uint64_t(128) << 20;

// Textures are halved, the largest first, until the pool fits `maximumBytes`; that is logged.
// Throws Error when even textures of one texel do not fit.
TexturePool packTextures(const Scene& scene, std::uint64_t maximumBytes = kTexturePoolBytes);

std::vector<gpu::GpuMaterial> packMaterials(const Scene& scene);
std::vector<gpu::GpuLight> packLights(const Scene& scene);

// --- The CPU twin: same names, same arithmetic. ---

inline constexpr float kFullResolution = -100.0f;

struct SurfaceMaterial
{
    glm::vec3 baseColor = glm::vec3(1.0f);
    float alpha = 1.0f;
    float metallic = 0.0f;
    float roughness = 1.0f;
    glm::vec3 emissive = glm::vec3(0.0f);
    glm::vec3 normal = glm::vec3(0.0f, 0.0f, 1.0f); // tangent space
    float specular = 1.0f;
    glm::vec3 specularColor = glm::vec3(1.0f);
    float alphaCutoff = -1.0f;
    bool doubleSided = false;
};

// Trilinear. `lod` is log2 of the footprint's width in texture coordinates.
glm::vec4 sampleTexture(const TexturePool& pool, std::uint32_t texture, glm::vec2 uv, float lod);

SurfaceMaterial evaluateMaterial(const TexturePool& pool, const gpu::GpuMaterial& material,
                                 glm::vec2 uv0, glm::vec2 uv1, float lod);

} // namespace strandlight
