// Materials and lights in the layout of shaders/shared/scene_types.h.

#include "engine/scene/texture_pool.hpp"

namespace strandlight {

static_assert(sizeof(gpu::GpuMaterial) == gpu::kMaterialTexels * 16);
static_assert(sizeof(gpu::GpuLight) == 52);

namespace {

gpu::GpuTextureSlot packSlot(const TextureSlot& slot, bool srgb)
{
    gpu::GpuTextureSlot packed{};
    const glm::mat3 rows = glm::transpose(slot.transform);
    packed.rowU = rows[0];
    packed.rowV = rows[1];
    packed.texture = slot.texture < 0 ? -1.0f : float(2 * slot.texture + (srgb ? 1 : 0));
    packed.texCoord = float(slot.texCoord);
    return packed;
}

gpu::GpuMaterial packMaterial(const Material& material)
{
    gpu::GpuMaterial packed{};
    packed.baseColor = material.baseColor;
    packed.emissive = material.emissive;
    packed.metallic = material.metallic;
    packed.specularColor = material.specularColor;
    packed.specular = material.specular;
    packed.roughness = material.roughness;
    packed.normalScale = material.normalScale;
    packed.alphaCutoff = material.alphaCutoff;
    packed.baseColorTexture = packSlot(material.baseColorTexture, true);
    packed.metallicRoughnessTexture = packSlot(material.metallicRoughnessTexture, false);
    packed.normalTexture = packSlot(material.normalTexture, false);
    packed.emissiveTexture = packSlot(material.emissiveTexture, true);
    std::uint32_t flags = material.doubleSided ? gpu::kMaterialDoubleSided : 0u;
    const auto note = [&](const TextureSlot& slot, std::uint32_t bit) {
        flags |= slot.texture >= 0 ? bit : 0u;
    };
    note(material.baseColorTexture, gpu::kMaterialBaseColorTexture);
    note(material.metallicRoughnessTexture, gpu::kMaterialMetallicRoughnessTexture);
    note(material.normalTexture, gpu::kMaterialNormalTexture);
    note(material.emissiveTexture, gpu::kMaterialEmissiveTexture);
    packed.flags = float(flags);
    return packed;
}

gpu::GpuLight packLight(const PunctualLight& light)
{
    gpu::GpuLight packed{};
    packed.type = static_cast<std::uint32_t>(light.type);
    packed.position = light.position;
    packed.direction = light.direction;
    packed.intensity = light.intensity;
    packed.range = light.range;
    if (light.type == LightType::Spot) {
        // KHR_lights_punctual keeps the cone's edge wider than 0.001 in cosine.
        const float width = light.innerConeCos - light.outerConeCos;
        packed.coneScale = 1.0f / (width > 0.001f ? width : 0.001f);
        packed.coneOffset = -light.outerConeCos * packed.coneScale;
    }
    return packed;
}

} // namespace

std::vector<gpu::GpuMaterial> packMaterials(const Scene& scene)
{
    std::vector<gpu::GpuMaterial> packed;
    packed.reserve(scene.materials.size());
    for (const Material& material : scene.materials)
        packed.push_back(packMaterial(material));
    return packed;
}

std::vector<gpu::GpuLight> packLights(const Scene& scene)
{
    std::vector<gpu::GpuLight> packed;
    packed.reserve(scene.lights.size());
    for (const PunctualLight& light : scene.lights)
        packed.push_back(packLight(light));
    return packed;
}

} // namespace strandlight
