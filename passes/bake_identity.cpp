#include "passes/bake_identity.hpp"

#include "engine/base/fnv1a.hpp"

namespace strandlight {

std::uint64_t hashGeometry(const Scene& scene)
{
    Fnv1a hash;
    for (const glm::uvec3& triangle : scene.triangles)
        for (int corner = 0; corner < 3; ++corner)
            hash.value(scene.vertices[triangle[corner]].position);
    return hash.result();
}

std::uint64_t hashEnvironment(const Scene& scene)
{
    Fnv1a hash;
    if (scene.environment) {
        const CpuImage& image = scene.environment->latLong;
        hash.value(image.width);
        hash.bytes(image.pixels.data(), image.pixels.size() * sizeof(glm::vec4));
    }
    return scene.environment ? hash.result() : 0;
}

std::uint64_t hashScene(const Scene& scene)
{
    Fnv1a hash;
    hash.value(hashGeometry(scene));
    hash.value(hashEnvironment(scene));
    for (const Vertex& vertex : scene.vertices)
        hash.value(vertex); // floats without padding
    hash.bytes(scene.triangleMaterials.data(),
               scene.triangleMaterials.size() * sizeof(std::uint32_t));
    for (const Material& m : scene.materials) {
        for (const glm::vec3& v : {glm::vec3(m.baseColor), m.specularColor, m.emissive})
            hash.value(v);
        for (const float v : {m.metallic, m.roughness, m.specular, m.normalScale, m.alphaCutoff})
            hash.value(v);
        hash.value(m.doubleSided);
        for (const TextureSlot* slot : {&m.baseColorTexture, &m.metallicRoughnessTexture,
                                        &m.normalTexture, &m.emissiveTexture}) {
            hash.value(slot->texture);
            hash.value(slot->texCoord);
            hash.value(slot->transform);
        }
    }
    for (const Texture& texture : scene.textures)
        hash.bytes(texture.rgba.data(), texture.rgba.size());
    for (const PunctualLight& light : scene.lights) {
        for (const glm::vec3& v : {light.position, light.direction, light.intensity})
            hash.value(v);
        for (const float v :
             {float(light.type), light.range, light.innerConeCos, light.outerConeCos})
            hash.value(v);
    }
    return hash.result();
}

std::uint64_t hashBake(const Scene& scene, const BakeSettings& s)
{
    Fnv1a hash;
    hash.value(hashScene(scene));
    for (const std::uint32_t v :
         {s.atlasResolution, s.lightfieldSize, s.lobes, s.environmentLobes, s.samplesPerDirection,
          s.bounces, s.steps, s.seed, std::uint32_t(s.fit), s.lobeTile})
        hash.value(v);
    hash.value(s.lobeError);
    return hash.result();
}

} // namespace strandlight
