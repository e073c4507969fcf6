// A static scene on the CPU: world-space triangles, materials, textures, cameras, lights.
// Node transforms are already applied; units are metres, right-handed, +y up (glTF 2.0).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "engine/base/image.hpp"

namespace strandlight {

enum class TextureWrap : std::uint32_t
{
    Repeat = 0,
    ClampToEdge = 1,
    MirroredRepeat = 2
};

struct Texture
{
    std::string name;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba; // [height, width, 4], row 0 at v = 0, as stored in the file
    TextureWrap wrapU = TextureWrap::Repeat;
    TextureWrap wrapV = TextureWrap::Repeat;
};

// Which texture, which UV set, and KHR_texture_transform: uv' = transform * (u, v, 1).
struct TextureSlot
{
    std::int32_t texture = -1; // index into Scene::textures, -1: none
    std::int32_t texCoord = 0; // 0 or 1
    glm::mat3 transform = glm::mat3(1.0f);
};

// glTF metallic-roughness with KHR_materials_specular, _emissive_strength. Factors are linear.
struct Material
{
    std::string name;
    glm::vec4 baseColor = glm::vec4(1.0f);
    float metallic = 1.0f;
    float roughness = 1.0f; // perceptual; alpha = roughness^2
    float specular = 1.0f;  // KHR_materials_specular factor
    glm::vec3 specularColor = glm::vec3(1.0f);
    glm::vec3 emissive = glm::vec3(0.0f); // W / (sr m^2), strength multiplied in
    float normalScale = 1.0f;
    float alphaCutoff = -1.0f; // < 0: opaque; else alpha mask
    bool doubleSided = false;
    TextureSlot baseColorTexture;         // sRGB
    TextureSlot metallicRoughnessTexture; // linear: G roughness, B metallic
    TextureSlot normalTexture;            // linear
    TextureSlot emissiveTexture;          // sRGB
};

struct Vertex
{
    glm::vec3 position = glm::vec3(0.0f);
    glm::vec3 normal = glm::vec3(0.0f, 0.0f, 1.0f);        // unit
    glm::vec4 tangent = glm::vec4(1.0f, 0.0f, 0.0f, 1.0f); // for normal maps; w: handedness
    glm::vec2 uv0 = glm::vec2(0.0f);
    glm::vec2 uv1 = glm::vec2(0.0f);
};

struct Camera
{
    glm::vec3 eye = glm::vec3(0.0f, 0.0f, 1.0f);
    glm::vec3 target = glm::vec3(0.0f);
    glm::vec3 up = glm::vec3(0.0f, 1.0f, 0.0f);
    float verticalFovDegrees = 45.0f;
};

enum class LightType : std::uint32_t
{
    Point = 0,
    Spot = 1,
    Directional = 2
};

// KHR_lights_punctual. intensity: candela (point, spot) or lux (directional), times colour.
struct PunctualLight
{
    LightType type = LightType::Point;
    glm::vec3 position = glm::vec3(0.0f);
    glm::vec3 direction = glm::vec3(0.0f, 0.0f, -1.0f); // the way the light travels, unit
    glm::vec3 intensity = glm::vec3(1.0f);
    float range = 0.0f; // 0: infinite
    float innerConeCos = 1.0f;
    float outerConeCos = 0.70710678f;
};

// A distant environment: lat-long radiance. Direction +y is row 0, and u = 0.5 + atan2(d.x, -d.z) /
// (2 pi).
struct Environment
{
    CpuImage latLong;
};

struct Scene
{
    std::string name;
    std::vector<Vertex> vertices;
    std::vector<glm::uvec3> triangles;            // indices into vertices
    std::vector<std::uint32_t> triangleMaterials; // [triangles]
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Camera> cameras;
    std::vector<PunctualLight> lights;
    std::optional<Environment> environment;
    bool hasTexCoord1 = false; // every primitive brought TEXCOORD_1

    glm::vec3 boundsMin() const;
    glm::vec3 boundsMax() const;
};

} // namespace strandlight
