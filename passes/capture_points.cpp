#include "passes/capture_points.hpp"

namespace strandlight {

gpu::CapturePoint capturePoint(const Scene& scene, const Atlas& atlas, const AtlasTexel& texel)
{
    const glm::uvec3 t = scene.triangles[texel.triangle];
    const Vertex* v[3] = {&scene.vertices[t.x], &scene.vertices[t.y], &scene.vertices[t.z]};
    // A texel on the border of its triangle may lie exactly on the next wall: half its rays would
    // start behind it.
    const glm::vec2 inner = glm::mix(texel.barycentric, glm::vec2(1.0f / 3.0f), 0.002f);
    const float w[3] = {1.0f - inner.x - inner.y, inner.x, inner.y};
    gpu::CapturePoint point{};
    glm::vec3 tangent(0.0f);
    for (int k = 0; k < 3; ++k) {
        point.position += w[k] * v[k]->position;
        point.normal += w[k] * v[k]->normal;
        tangent += w[k] * atlas.corners[std::size_t(texel.triangle) * 3 + std::size_t(k)].tangent;
    }
    const glm::vec3 e1 = v[1]->position - v[0]->position;
    const glm::vec3 e2 = v[2]->position - v[0]->position;
    const glm::vec3 cross = glm::cross(e1, e2);
    point.geometric = glm::dot(cross, cross) > 0.0f ? glm::normalize(cross) : v[0]->normal;
    if (!(glm::dot(point.normal, point.normal) > 1e-12f))
        point.normal = point.geometric;
    point.normal = glm::normalize(point.normal);
    if (glm::dot(point.geometric, point.normal) < 0.0f)
        point.geometric = -point.geometric;
    tangent -= point.normal * glm::dot(point.normal, tangent);
    glm::vec3 bitangent;
    if (glm::dot(tangent, tangent) > 1e-12f)
        point.tangent = glm::normalize(tangent);
    else
        gpu::buildBasis(point.normal, point.tangent, bitangent);
    return point;
}

std::vector<gpu::CapturePoint> capturePoints(const Scene& scene, const Atlas& atlas)
{
    std::vector<gpu::CapturePoint> points;
    points.reserve(atlas.texels.size());
    for (const AtlasTexel& texel : atlas.texels)
        points.push_back(capturePoint(scene, atlas, texel));
    return points;
}

} // namespace strandlight
