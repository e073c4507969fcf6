#include "engine/scene/tangents.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace strandlight {

namespace {

struct Accumulated
{
    glm::vec3 tangent = glm::vec3(0.0f);
    float handedness = 0.0f;
};

// Any unit vector at a right angle to a unit normal.
glm::vec3 orthogonal(glm::vec3 n)
{
    const glm::vec3 axis =
        std::abs(n.x) < 0.7f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
    return glm::normalize(glm::cross(axis, n));
}

float cornerAngle(glm::vec3 a, glm::vec3 b)
{
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

glm::vec2 textureCoordinates(const Vertex& vertex, const TextureSlot& slot)
{
    return glm::vec2(slot.transform *
                     glm::vec3(slot.texCoord == 1 ? vertex.uv1 : vertex.uv0, 1.0f));
}

void accumulateTriangle(const Scene& scene, glm::uvec3 triangle, const TextureSlot& slot,
                        std::uint32_t firstVertex, std::vector<Accumulated>& sums)
{
    glm::vec3 p[3];
    glm::vec2 uv[3];
    for (int i = 0; i < 3; ++i) {
        p[i] = scene.vertices[triangle[i]].position;
        uv[i] = textureCoordinates(scene.vertices[triangle[i]], slot);
    }
    const glm::vec2 d1 = uv[1] - uv[0];
    const glm::vec2 d2 = uv[2] - uv[0];
    const float area = d1.x * d2.y - d2.x * d1.y;
    if (area == 0.0f)
        return;
    // dP/du up to a positive factor; dP/dv runs down the picture, so B = -dP/dv is cross(N, T) for
    // area < 0.
    const glm::vec3 direction =
        ((p[1] - p[0]) * d2.y - (p[2] - p[0]) * d1.y) * (area < 0.0f ? -1.0f : 1.0f);
    const float length = glm::length(direction);
    if (!(length > 0.0f) || !std::isfinite(length))
        return;
    for (int i = 0; i < 3; ++i) {
        const float angle = cornerAngle(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
        Accumulated& sum = sums[triangle[i] - firstVertex];
        sum.tangent += direction * (angle / length);
        sum.handedness += area < 0.0f ? angle : -angle;
    }
}

} // namespace

void generateTangents(Scene& scene, std::size_t firstTriangle, const TextureSlot& slot)
{
    if (firstTriangle >= scene.triangles.size())
        return;
    std::uint32_t firstVertex = std::numeric_limits<std::uint32_t>::max();
    for (std::size_t t = firstTriangle; t < scene.triangles.size(); ++t) {
        const glm::uvec3 triangle = scene.triangles[t];
        firstVertex = std::min({firstVertex, triangle.x, triangle.y, triangle.z});
    }
    std::vector<Accumulated> sums(scene.vertices.size() - firstVertex);
    for (std::size_t t = firstTriangle; t < scene.triangles.size(); ++t)
        accumulateTriangle(scene, scene.triangles[t], slot, firstVertex, sums);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        Vertex& vertex = scene.vertices[firstVertex + i];
        const glm::vec3 n = vertex.normal;
        const glm::vec3 t = sums[i].tangent - n * glm::dot(n, sums[i].tangent);
        const float length = glm::length(t);
        vertex.tangent = glm::vec4(length > 1e-6f ? t / length : orthogonal(n),
                                   sums[i].handedness < 0.0f ? -1.0f : 1.0f);
    }
}

} // namespace strandlight
