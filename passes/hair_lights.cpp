#include "passes/hair_lights.hpp"

#include <algorithm>
#include <cmath>

namespace strandlight {
namespace {

constexpr float kBiasTexels = 1.5f;

// Right-handed look-at with Vulkan's depth, along `forward`; the lateral axes are arbitrary.
glm::mat4 lookAlong(glm::vec3 eye, glm::vec3 forward)
{
    const glm::vec3 helper = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 right = glm::normalize(glm::cross(forward, helper));
    const glm::vec3 up = glm::cross(right, forward);
    const glm::mat3 rows = glm::transpose(glm::mat3(right, -up, forward));
    glm::mat4 view(rows);
    view[3] = glm::vec4(-(rows * eye), 1.0f);
    return view;
}

// How far opaque geometry reaches from the sphere's centre towards a light.
float reachTowards(const Scene* opaque, const HairSphere& sphere, glm::vec3 towards)
{
    float reach = sphere.radius;
    if (opaque)
        for (const Vertex& vertex : opaque->vertices)
            reach = std::max(reach, glm::dot(vertex.position - sphere.centre, towards));
    return 1.01f * reach;
}

void aimShadow(gpu::HairLight& light, const HairSphere& sphere, const Scene* opaque,
               std::uint32_t size)
{
    glm::mat4 projection(0.0f);
    if (light.type == std::uint32_t(LightType::Directional)) {
        const float back = reachTowards(opaque, sphere, -light.direction);
        projection[0][0] = projection[1][1] = 1.0f / sphere.radius;
        projection[2][2] = 1.0f / (back + sphere.radius);
        projection[3][3] = 1.0f;
        light.shadowMatrix =
            projection * lookAlong(sphere.centre - back * light.direction, light.direction);
        light.shadowBias = kBiasTexels * 2.0f * sphere.radius / float(size);
        return;
    }
    const glm::vec3 path = sphere.centre - light.position;
    const float distance = glm::length(path);
    if (!(distance > sphere.radius))
        return; // hairLightCastsShadow is false
    const float tangent =
        sphere.radius / std::sqrt(distance * distance - sphere.radius * sphere.radius);
    const float far = distance + sphere.radius;
    const float near = 1e-3f * far;
    projection[0][0] = projection[1][1] = 1.0f / tangent;
    projection[2][2] = far / (far - near);
    projection[2][3] = 1.0f;
    projection[3][2] = -far * near / (far - near);
    light.shadowMatrix = projection * lookAlong(light.position, path / distance);
    light.shadowBias = kBiasTexels * 2.0f * tangent * distance / float(size);
}

} // namespace

HairSphere boundingSphere(const HairStrands& hair)
{
    const glm::vec3 low = hair.boundsMin();
    const glm::vec3 high = hair.boundsMax();
    const float widest =
        hair.radii.empty() ? 0.0f : *std::max_element(hair.radii.begin(), hair.radii.end());
    return {0.5f * (low + high), 0.51f * glm::length(high - low) + widest + 1e-6f};
}

std::vector<gpu::HairLight> hairLights(const HairStrands& hair, const Scene* opaque,
                                       const HairRenderSettings& settings)
{
    std::vector<PunctualLight> sources;
    if (opaque)
        sources = opaque->lights;
    if (sources.empty() && !settings.distant)
        sources.push_back({.type = LightType::Directional,
                           .direction = -glm::normalize(settings.keyDirection),
                           .intensity = settings.keyIrradiance});
    const HairSphere sphere = boundingSphere(hair);
    std::vector<gpu::HairLight> lights;
    for (const PunctualLight& source : sources) {
        gpu::HairLight light{};
        light.position = source.position;
        light.type = std::uint32_t(source.type);
        light.direction = source.direction;
        light.range = source.range;
        light.intensity = source.intensity;
        light.innerConeCos = source.innerConeCos;
        light.outerConeCos = source.outerConeCos;
        aimShadow(light, sphere, opaque, settings.shadowSize);
        lights.push_back(light);
    }
    return lights;
}

gpu::HairLight hairShadowDirection(const HairStrands& hair, const Scene* opaque, glm::vec3 towards,
                                   std::uint32_t shadowSize)
{
    gpu::HairLight light{};
    light.type = std::uint32_t(LightType::Directional);
    light.direction = -towards;
    aimShadow(light, boundingSphere(hair), opaque, shadowSize);
    return light;
}

float hairLightShare(std::span<const gpu::HairLight> lights, const HairRenderSettings& settings)
{
    return 1.0f / float(std::max<std::size_t>(1, lights.size() + (settings.distant ? 1 : 0)));
}

bool hairLightCastsShadow(const HairStrands& hair, const gpu::HairLight& light)
{
    const HairSphere sphere = boundingSphere(hair);
    return light.type == std::uint32_t(LightType::Directional) ||
           glm::length(light.position - sphere.centre) > 1.05f * sphere.radius;
}

} // namespace strandlight
