#include "engine/scene/hair_head.hpp"

#include <algorithm>

#include "engine/scene/mesh_builder.hpp"
#include "engine/scene/procedural.hpp"

namespace strandlight {

namespace {

PunctualLight directional(glm::vec3 towards, float lux)
{
    PunctualLight light;
    light.type = LightType::Directional;
    light.direction = glm::normalize(towards);
    light.intensity = glm::vec3(lux);
    return light;
}

} // namespace

float headLevel(glm::vec3 point)
{
    return glm::length(point / kHeadRadii);
}

glm::vec3 headNormal(glm::vec3 point)
{
    return glm::normalize(point / (kHeadRadii * kHeadRadii));
}

float lowestHeadLevel(glm::vec3 a, glm::vec3 b)
{
    // In the space where the head is the unit sphere.
    const glm::vec3 start = a / kHeadRadii;
    const glm::vec3 along = b / kHeadRadii - start;
    const float square = glm::dot(along, along);
    const float t = square > 0.0f ? std::clamp(-glm::dot(start, along) / square, 0.0f, 1.0f) : 0.0f;
    return glm::length(start + t * along);
}

Scene headScene()
{
    Scene scene;
    scene.name = "head";
    MeshBuilder mesh(scene);
    Material skin;
    skin.name = "skin";
    skin.baseColor = glm::vec4(0.6f, 0.42f, 0.33f, 1.0f);
    skin.metallic = 0.0f;
    skin.roughness = 0.6f;
    mesh.useMaterial(skin);
    mesh.sphere(glm::vec3(0.0f), 1.0f, 3);
    for (Vertex& vertex : scene.vertices) { // from the unit sphere to the head
        vertex.normal = headNormal(vertex.position * kHeadRadii);
        vertex.position *= kHeadRadii;
        const glm::vec3 tangent = glm::vec3(vertex.tangent) * kHeadRadii;
        vertex.tangent = glm::vec4(glm::normalize(tangent), vertex.tangent.w);
        vertex.uv0 = glm::vec2(vertex.position);
    }
    mesh.tube(glm::vec3(0.0f, -0.2f, -0.02f), 0.045f, 0.15f, 32);
    // Irradiance pi makes a white Lambert surface that faces the light as bright as 1.
    scene.lights = {directional({-0.5f, -0.8f, -1.0f}, 3.1415927f),
                    directional({0.4f, -0.5f, 1.0f}, 2.0f)};
    return scene;
}

Scene buildBustScene()
{
    Scene scene = buildRoomScene();
    const Scene head = headScene();
    const std::uint32_t firstVertex = std::uint32_t(scene.vertices.size());
    const std::uint32_t firstMaterial = std::uint32_t(scene.materials.size());
    for (Vertex vertex : head.vertices) {
        vertex.position += kBustPlace;
        scene.vertices.push_back(vertex);
    }
    for (const glm::uvec3& triangle : head.triangles)
        scene.triangles.push_back(triangle + firstVertex);
    for (const std::uint32_t material : head.triangleMaterials)
        scene.triangleMaterials.push_back(material + firstMaterial);
    scene.materials.insert(scene.materials.end(), head.materials.begin(), head.materials.end());
    scene.name = "bust";
    return scene;
}

} // namespace strandlight
