#include "engine/scene/atlas_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "engine/base/error.hpp"

namespace strandlight {

namespace {

constexpr float kThinness = 1e-6f;        // height / longest edge
constexpr std::size_t kMaximumFanout = 8; // triangles at one edge; more is not a surface

struct HalfEdge
{
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    std::uint32_t triangle = 0;
    std::uint8_t edge = 0;
    bool forward = false; // runs from low to high
};

bool isFinite(glm::vec3 v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace

std::vector<std::uint32_t> weldPositions(std::span<const Vertex> vertices)
{
    const auto key = [&](std::uint32_t i) {
        const glm::vec3 p = vertices[i].position + 0.0f; // -0 becomes +0
        return std::tuple(p.x, p.y, p.z);
    };
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple(key(a), a) < std::tuple(key(b), b);
    });
    std::vector<std::uint32_t> welded(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
        welded[order[i]] = same ? welded[order[i - 1]] : order[i];
    }
    return welded;
}

AtlasMesh::AtlasMesh(const Scene& scene) : scene_(scene)
{
    for (std::size_t i = 0; i < scene.vertices.size(); ++i)
        if (!isFinite(scene.vertices[i].position) || !isFinite(scene.vertices[i].normal))
            throw Error("atlas: vertex " + std::to_string(i) + " is not finite");
    for (std::size_t i = 0; i < scene.triangles.size(); ++i)
        for (int c = 0; c < 3; ++c)
            if (scene.triangles[i][c] >= scene.vertices.size())
                throw Error("atlas: triangle " + std::to_string(i) + " uses vertex " +
                            std::to_string(scene.triangles[i][c]) + " of " +
                            std::to_string(scene.vertices.size()));
    computeFaces();
    if (std::all_of(thin_.begin(), thin_.end(), [](bool thin) { return thin; }))
        throw Error("atlas: none of the scene's " + std::to_string(scene.triangles.size()) +
                    " triangles has an area");
    computeNeighbours();
}

glm::vec3 AtlasMesh::position(std::uint32_t triangle, std::uint32_t corner) const
{
    return scene_.vertices[scene_.triangles[triangle][static_cast<int>(corner)]].position;
}

glm::vec3 AtlasMesh::shadingNormal(std::uint32_t triangle, std::uint32_t corner) const
{
    return scene_.vertices[scene_.triangles[triangle][static_cast<int>(corner)]].normal;
}

std::span<const AtlasNeighbour> AtlasMesh::neighbours(std::uint32_t triangle) const
{
    const std::uint32_t first = firstNeighbour_[triangle];
    return std::span(neighbours_).subspan(first, firstNeighbour_[triangle + 1] - first);
}

// In double: areas of millimetre triangles far from the origin cancel in float.
void AtlasMesh::computeFaces()
{
    const std::size_t count = scene_.triangles.size();
    normals_.assign(count, glm::vec3(0.0f));
    areas_.assign(count, 0.0f);
    thin_.assign(count, true);
    for (std::uint32_t t = 0; t < count; ++t) {
        const glm::dvec3 a(position(t, 0));
        const glm::dvec3 ab = glm::dvec3(position(t, 1)) - a;
        const glm::dvec3 ac = glm::dvec3(position(t, 2)) - a;
        const glm::dvec3 bc = ac - ab;
        const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
        const glm::dvec3 cross = glm::cross(ab, ac);
        const double twiceArea = glm::length(cross);
        areas_[t] = static_cast<float>(0.5 * twiceArea);
        thin_[t] = !(twiceArea > kThinness * longest) || !(areas_[t] > 0.0f);
        if (!thin_[t])
            normals_[t] = glm::vec3(cross / twiceArea);
    }
}

void AtlasMesh::computeNeighbours()
{
    const std::vector<std::uint32_t> welded = weldPositions(scene_.vertices);
    std::vector<HalfEdge> edges;
    edges.reserve(scene_.triangles.size() * 3);
    for (std::uint32_t t = 0; t < triangleCount(); ++t) {
        for (std::uint8_t e = 0; e < 3; ++e) {
            const std::uint32_t a = welded[scene_.triangles[t][e]];
            const std::uint32_t b = welded[scene_.triangles[t][(e + 1) % 3]];
            if (a != b)
                edges.push_back({std::min(a, b), std::max(a, b), t, e, a < b});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle, a.edge) <
               std::tie(b.low, b.high, b.triangle, b.edge);
    });

    std::vector<std::vector<AtlasNeighbour>> lists(triangleCount());
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i;
        while (end < edges.size() && edges[end].low == edges[i].low &&
               edges[end].high == edges[i].high)
            ++end;
        if (end - i <= kMaximumFanout)
            for (std::size_t a = i; a < end; ++a)
                for (std::size_t b = i; b < end; ++b)
                    if (edges[a].triangle != edges[b].triangle)
                        lists[edges[a].triangle].push_back({edges[b].triangle, edges[a].edge,
                                                            edges[b].edge,
                                                            edges[a].forward == edges[b].forward});
        i = end;
    }
    firstNeighbour_.assign(triangleCount() + 1, 0);
    for (std::uint32_t t = 0; t < triangleCount(); ++t) {
        neighbours_.insert(neighbours_.end(), lists[t].begin(), lists[t].end());
        firstNeighbour_[t + 1] = static_cast<std::uint32_t>(neighbours_.size());
    }
}

} // namespace strandlight
