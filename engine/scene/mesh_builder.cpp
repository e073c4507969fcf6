#include "engine/scene/mesh_builder.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <glm/gtc/constants.hpp>

namespace strandlight {

void MeshBuilder::useMaterial(const Material& material)
{
    material_ = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(material);
}

void MeshBuilder::turn(float degrees, glm::vec3 pivot)
{
    const float c = std::cos(glm::radians(degrees));
    const float s = std::sin(glm::radians(degrees));
    rotation_ = glm::mat3(c, 0.0f, -s, 0.0f, 1.0f, 0.0f, s, 0.0f, c);
    pivot_ = pivot;
}

std::uint32_t MeshBuilder::addVertex(glm::vec3 position, glm::vec3 normal, glm::vec3 tangent,
                                     glm::vec2 uv)
{
    Vertex vertex;
    vertex.position = rotation_ * (position - pivot_) + pivot_;
    vertex.normal = glm::normalize(rotation_ * normal);
    vertex.tangent = glm::vec4(glm::normalize(rotation_ * tangent), 1.0f);
    vertex.uv0 = uv;
    scene_.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(scene_.vertices.size() - 1);
}

void MeshBuilder::addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c)
{
    scene_.triangles.emplace_back(a, b, c);
    scene_.triangleMaterials.push_back(material_);
}

void MeshBuilder::quad(glm::vec3 origin, glm::vec3 u, glm::vec3 v)
{
    const glm::vec3 normal = glm::normalize(glm::cross(u, v));
    const float width = glm::length(u);
    const float height = glm::length(v);
    // glTF's v runs down the image, so it falls along `v`.
    const std::uint32_t a = addVertex(origin, normal, u, {0.0f, height});
    const std::uint32_t b = addVertex(origin + u, normal, u, {width, height});
    const std::uint32_t c = addVertex(origin + u + v, normal, u, {width, 0.0f});
    const std::uint32_t d = addVertex(origin + v, normal, u, {0.0f, 0.0f});
    addTriangle(a, b, c);
    addTriangle(a, c, d);
}

void MeshBuilder::box(glm::vec3 low, glm::vec3 high, std::uint32_t faces, bool inward)
{
    const glm::vec3 size = high - low;
    const glm::vec3 x(size.x, 0.0f, 0.0f);
    const glm::vec3 y(0.0f, size.y, 0.0f);
    const glm::vec3 z(0.0f, 0.0f, size.z);
    const auto face = [&](std::uint32_t bit, glm::vec3 origin, glm::vec3 u, glm::vec3 v) {
        if ((faces & bit) == 0)
            return;
        if (inward)
            quad(origin + u, -u, v);
        else
            quad(origin, u, v);
    };
    face(kFaceMinX, low, z, y);
    face(kFaceMaxX, low + x + z, -z, y);
    face(kFaceMinY, low, x, z);
    face(kFaceMaxY, low + y + z, x, -z);
    face(kFaceMinZ, low + x, -x, y);
    face(kFaceMaxZ, low + z, x, y);
}

void MeshBuilder::sphere(glm::vec3 centre, float radius, int levels)
{
    const float t = 0.5f * (1.0f + std::sqrt(5.0f));
    std::vector<glm::vec3> points = {{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0},
                                     {0, -1, t}, {0, 1, t}, {0, -1, -t}, {0, 1, -t},
                                     {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}};
    std::vector<glm::uvec3> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (glm::vec3& point : points)
        point = glm::normalize(point);

    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [entry, isNew] = middles.try_emplace(std::minmax(a, b), points.size());
            if (isNew)
                points.push_back(glm::normalize(points[a] + points[b]));
            return entry->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& f : faces) {
            const std::uint32_t ab = middle(f.x, f.y);
            const std::uint32_t bc = middle(f.y, f.z);
            const std::uint32_t ca = middle(f.z, f.x);
            finer.insert(finer.end(), {{f.x, ab, ca}, {f.y, bc, ab}, {f.z, ca, bc}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }

    const auto first = static_cast<std::uint32_t>(scene_.vertices.size());
    for (const glm::vec3& n : points) {
        const glm::vec3 tangent =
            std::abs(n.y) < 0.999f ? glm::vec3(n.z, 0.0f, -n.x) : glm::vec3(1.0f, 0.0f, 0.0f);
        addVertex(centre + radius * n, n, tangent, glm::vec2(n.x, n.y) * radius);
    }
    for (const glm::uvec3& f : faces)
        addTriangle(first + f.x, first + f.y, first + f.z);
}

void MeshBuilder::tube(glm::vec3 base, float radius, float height, int sides)
{
    const auto first = static_cast<std::uint32_t>(scene_.vertices.size());
    for (int i = 0; i <= sides; ++i) {
        // The seam repeats the first column exactly, so that no ray slips through it.
        const float angle = glm::two_pi<float>() * float(i % sides) / float(sides);
        const glm::vec3 out(std::sin(angle), 0.0f, std::cos(angle));
        const glm::vec3 along(out.z, 0.0f, -out.x);
        const float u = glm::two_pi<float>() * radius * float(i) / float(sides);
        addVertex(base + radius * out, out, along, {u, height});
        addVertex(base + radius * out + glm::vec3(0.0f, height, 0.0f), out, along, {u, 0.0f});
    }
    for (int i = 0; i < sides; ++i) {
        const std::uint32_t a = first + 2 * static_cast<std::uint32_t>(i);
        addTriangle(a, a + 2, a + 3);
        addTriangle(a, a + 3, a + 1);
    }
}

void MeshBuilder::torus(glm::vec3 centre, float major, float minor, int majorSides, int minorSides)
{
    const auto first = static_cast<std::uint32_t>(scene_.vertices.size());
    for (int i = 0; i < majorSides; ++i) {
        const float a = glm::two_pi<float>() * float(i) / float(majorSides);
        const glm::vec3 out(std::sin(a), 0.0f, std::cos(a));
        const glm::vec3 along(out.z, 0.0f, -out.x);
        for (int j = 0; j < minorSides; ++j) {
            const float b = glm::two_pi<float>() * float(j) / float(minorSides);
            const glm::vec3 normal = std::cos(b) * out + glm::vec3(0.0f, std::sin(b), 0.0f);
            addVertex(centre + major * out + minor * normal, normal, along,
                      {major * a, -minor * b});
        }
    }
    for (int i = 0; i < majorSides; ++i) {
        for (int j = 0; j < minorSides; ++j) {
            const auto at = [&](int p, int q) {
                return first +
                       static_cast<std::uint32_t>((p % majorSides) * minorSides + q % minorSides);
            };
            addTriangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            addTriangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
}

} // namespace strandlight
