// The CPU twin of shaders/lib/textures.glsl. Same names, same order of operations.

#include <algorithm>
#include <cmath>

#include "engine/base/image_io.hpp"
#include "engine/scene/texture_pool.hpp"

namespace strandlight {

namespace {

int wrapTexel(int i, int size, std::uint32_t mode)
{
    if (mode == 1u)
        return std::clamp(i, 0, size - 1);
    const int period = mode == 2u ? 2 * size : size;
    const int m = (i + period) % period;
    return m < size ? m : period - 1 - m;
}

glm::vec4 fetchTexel(const TexturePool& pool, std::uint32_t start, glm::ivec2 size,
                     glm::ivec2 texel, std::uint32_t flags)
{
    const int x = wrapTexel(texel.x, size.x, (flags >> 8u) & 3u);
    const int y = wrapTexel(texel.y, size.y, (flags >> 10u) & 3u);
    const std::uint32_t word = pool.words[start + std::uint32_t(y * size.x + x)];
    glm::vec4 c(float(word & 255u), float((word >> 8u) & 255u), float((word >> 16u) & 255u),
                float(word >> 24u));
    c /= 255.0f;
    if ((flags & 0x1000u) != 0u)
        c = glm::vec4(decodeSrgb(c.x), decodeSrgb(c.y), decodeSrgb(c.z), c.w);
    return c;
}

glm::vec4 fetchBilinear(const TexturePool& pool, std::uint32_t record, std::uint32_t level,
                        glm::ivec2 size, glm::vec2 uv, std::uint32_t flags)
{
    const std::uint32_t start = pool.words[record + 3u + level];
    size = glm::max(size >> int(level), glm::ivec2(1));
    if (((flags >> 8u) & 3u) != 1u)
        uv.x -= 2.0f * std::floor(0.5f * uv.x);
    if (((flags >> 10u) & 3u) != 1u)
        uv.y -= 2.0f * std::floor(0.5f * uv.y);
    const glm::vec2 p = glm::clamp(uv, glm::vec2(-2.0f), glm::vec2(3.0f)) * glm::vec2(size) - 0.5f;
    const glm::vec2 base = glm::floor(p);
    const glm::vec2 f = p - base;
    const glm::ivec2 t(base);
    const auto texel = [&](int x, int y) {
        return fetchTexel(pool, start, size, t + glm::ivec2(x, y), flags);
    };
    const glm::vec4 low = glm::mix(texel(0, 0), texel(1, 0), f.x);
    const glm::vec4 high = glm::mix(texel(0, 1), texel(1, 1), f.x);
    return glm::mix(low, high, f.y);
}

glm::vec4 sampleSlot(const TexturePool& pool, const gpu::GpuTextureSlot& slot, glm::vec2 uv0,
                     glm::vec2 uv1, float lod)
{
    const glm::vec3 uv(slot.texCoord > 0.5f ? uv1 : uv0, 1.0f);
    const float scale = std::abs(slot.rowU.x * slot.rowV.y - slot.rowU.y * slot.rowV.x);
    const float slotLod = lod + 0.5f * std::log2(std::max(scale, 1e-20f));
    return sampleTexture(pool, std::uint32_t(slot.texture),
                         glm::vec2(glm::dot(slot.rowU, uv), glm::dot(slot.rowV, uv)), slotLod);
}

} // namespace

glm::vec4 sampleTexture(const TexturePool& pool, std::uint32_t texture, glm::vec2 uv, float lod)
{
    const std::uint32_t record = texture * gpu::kTextureRecordWords;
    const std::uint32_t sizeWord = pool.words[record];
    const std::uint32_t flags = pool.words[record + 1u];
    const glm::ivec2 size(int(sizeWord & 0xffffu), int(sizeWord >> 16u));
    const float last = float((flags & 0xffu) - 1u);
    const float level = std::clamp(lod + std::log2(float(std::max(size.x, size.y))), 0.0f, last);
    const std::uint32_t fine = std::uint32_t(level);
    const float blend = level - float(fine);
    glm::vec4 color = fetchBilinear(pool, record, fine, size, uv, flags);
    if (blend > 0.0f)
        color = glm::mix(color, fetchBilinear(pool, record, fine + 1u, size, uv, flags), blend);
    return color;
}

SurfaceMaterial evaluateMaterial(const TexturePool& pool, const gpu::GpuMaterial& material,
                                 glm::vec2 uv0, glm::vec2 uv1, float lod)
{
    const std::uint32_t flags = std::uint32_t(material.flags);
    glm::vec4 color = material.baseColor;
    SurfaceMaterial m;
    m.metallic = material.metallic;
    m.roughness = material.roughness;
    m.emissive = material.emissive;
    m.specular = material.specular;
    m.specularColor = material.specularColor;
    m.alphaCutoff = material.alphaCutoff;
    m.doubleSided = (flags & gpu::kMaterialDoubleSided) != 0u;
    const auto slot = [&](const gpu::GpuTextureSlot& s) {
        return sampleSlot(pool, s, uv0, uv1, lod);
    };
    if ((flags & gpu::kMaterialBaseColorTexture) != 0u)
        color *= slot(material.baseColorTexture);
    if ((flags & gpu::kMaterialMetallicRoughnessTexture) != 0u) {
        const glm::vec4 t = slot(material.metallicRoughnessTexture);
        m.roughness *= t.y;
        m.metallic *= t.z;
    }
    if ((flags & gpu::kMaterialNormalTexture) != 0u) {
        glm::vec3 t = 2.0f * glm::vec3(slot(material.normalTexture)) - 1.0f;
        t = glm::vec3(t.x * material.normalScale, t.y * material.normalScale, t.z);
        const float squared = glm::dot(t, t);
        m.normal = squared > 1e-12f ? t / std::sqrt(squared) : glm::vec3(0.0f, 0.0f, 1.0f);
    }
    if ((flags & gpu::kMaterialEmissiveTexture) != 0u)
        m.emissive *= glm::vec3(slot(material.emissiveTexture));
    m.baseColor = glm::vec3(color);
    m.alpha = color.w;
    return m;
}

} // namespace strandlight
