#include "engine/scene/atlas_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace strandlight {

namespace {

constexpr float kOutsideTolerance = 1e-5f; // exporters round 1 up
constexpr float kSameUv = 1e-6f;           // of the unit square

class IslandFinder
{
public:
    explicit IslandFinder(std::uint32_t count) : parent_(count)
    {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    std::uint32_t find(std::uint32_t i)
    {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    // The smaller index leads, so the numbering does not depend on the order of joining.
    void join(std::uint32_t a, std::uint32_t b)
    {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

glm::vec2 uvOf(const AtlasMesh& mesh, std::uint32_t triangle, std::uint32_t corner)
{
    const Scene& scene = mesh.scene();
    return scene.vertices[scene.triangles[triangle][static_cast<int>(corner)]].uv1;
}

bool isOutside(glm::vec2 uv)
{
    return !(uv.x >= -kOutsideTolerance && uv.x <= 1.0f + kOutsideTolerance &&
             uv.y >= -kOutsideTolerance && uv.y <= 1.0f + kOutsideTolerance);
}

bool sameUv(glm::vec2 a, glm::vec2 b)
{
    return std::abs(a.x - b.x) <= kSameUv && std::abs(a.y - b.y) <= kSameUv;
}

// Both ends of the shared edge have the same UV in both triangles.
bool isUvConnected(const AtlasMesh& mesh, std::uint32_t triangle, const AtlasNeighbour& n)
{
    const std::uint32_t start = n.sameDirection ? n.otherEdge : (n.otherEdge + 1u) % 3;
    const std::uint32_t end = n.sameDirection ? (n.otherEdge + 1u) % 3 : n.otherEdge;
    return sameUv(uvOf(mesh, triangle, n.edge), uvOf(mesh, n.triangle, start)) &&
           sameUv(uvOf(mesh, triangle, (n.edge + 1u) % 3), uvOf(mesh, n.triangle, end));
}

void findIslands(const AtlasMesh& mesh, AtlasLayout& layout)
{
    IslandFinder finder(mesh.triangleCount());
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t)
        for (const AtlasNeighbour& n : mesh.neighbours(t))
            if (isUvConnected(mesh, t, n))
                finder.join(t, n.triangle);
    layout.chartOf.resize(mesh.triangleCount());
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
        const std::uint32_t leader = finder.find(t);
        layout.chartOf[t] = leader == t ? layout.chartCount++ : layout.chartOf[leader];
    }
}

double uvArea(const AtlasMesh& mesh, std::uint32_t t)
{
    const glm::dvec2 a(uvOf(mesh, t, 0));
    const glm::dvec2 ab = glm::dvec2(uvOf(mesh, t, 1)) - a;
    const glm::dvec2 ac = glm::dvec2(uvOf(mesh, t, 2)) - a;
    return 0.5 * (ab.x * ac.y - ab.y * ac.x);
}

// Direction of growing u on a triangle (unit): solves [ab ac] = [dP/du dP/dv] [uvAB uvAC].
glm::dvec3 directionOfU(const AtlasMesh& mesh, std::uint32_t t)
{
    const glm::dvec3 a(mesh.position(t, 0));
    const glm::dvec3 ab = glm::dvec3(mesh.position(t, 1)) - a;
    const glm::dvec3 ac = glm::dvec3(mesh.position(t, 2)) - a;
    const double vAB = uvOf(mesh, t, 1).y - uvOf(mesh, t, 0).y;
    const double vAC = uvOf(mesh, t, 2).y - uvOf(mesh, t, 0).y;
    const glm::dvec3 direction = (ab * vAC - ac * vAB) * (uvArea(mesh, t) < 0.0 ? -1.0 : 1.0);
    const double length = glm::length(direction);
    return length > 0.0 ? direction / length : glm::dvec3(0.0);
}

// Corners of equal position and UV in one island share the area-weighted mean of their triangles'
// directions.
void computeTangents(const AtlasMesh& mesh, AtlasLayout& layout)
{
    const std::vector<std::uint32_t> welded = weldPositions(mesh.scene().vertices);
    struct Key
    {
        std::uint32_t chart, vertex;
        glm::vec2 uv;
        std::uint32_t corner;
    };
    std::vector<Key> keys;
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t)
        for (std::uint32_t c = 0; c < 3; ++c)
            keys.push_back({layout.chartOf[t],
                            welded[mesh.scene().triangles[t][static_cast<int>(c)]],
                            uvOf(mesh, t, c), t * 3 + c});
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return std::tie(a.chart, a.vertex, a.uv.x, a.uv.y, a.corner) <
               std::tie(b.chart, b.vertex, b.uv.x, b.uv.y, b.corner);
    });
    for (std::size_t i = 0; i < keys.size();) {
        glm::dvec3 sum(0.0);
        std::size_t end = i;
        for (; end < keys.size() && keys[end].chart == keys[i].chart &&
               keys[end].vertex == keys[i].vertex && sameUv(keys[end].uv, keys[i].uv);
             ++end) {
            const std::uint32_t triangle = keys[end].corner / 3;
            sum += directionOfU(mesh, triangle) * static_cast<double>(mesh.area(triangle));
        }
        const double length = glm::length(sum);
        for (; i < end; ++i) {
            const glm::dvec3 own = directionOfU(mesh, keys[i].corner / 3);
            layout.corners[keys[i].corner].tangent = glm::vec3(length > 0.0 ? sum / length : own);
        }
    }
}

} // namespace

std::optional<AtlasLayout> layoutTexCoord1(const AtlasMesh& mesh, std::uint32_t resolution,
                                           std::string& reason)
{
    AtlasLayout layout;
    layout.corners.resize(std::size_t(mesh.triangleCount()) * 3);
    layout.sampleCorners.resize(mesh.triangleCount());
    double surfaceArea = 0.0;
    double totalUvArea = 0.0;
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
        for (std::uint32_t c = 0; c < 3; ++c) {
            const glm::vec2 uv = uvOf(mesh, t, c);
            if (isOutside(uv)) {
                reason = "triangle " + std::to_string(t) + " has the UV (" + std::to_string(uv.x) +
                         ", " + std::to_string(uv.y) + ")";
                return std::nullopt;
            }
            // Half a texel from the border on, so that bilinear lookups stay inside.
            const float margin = 0.5f;
            const glm::vec2 texels = glm::clamp(uv * static_cast<float>(resolution), margin,
                                                static_cast<float>(resolution) - margin);
            layout.corners[std::size_t(t) * 3 + c].uv = texels;
            layout.sampleCorners[t][c] = glm::dvec2(texels);
        }
        if (!mesh.isThin(t) && uvArea(mesh, t) == 0.0) {
            reason = "triangle " + std::to_string(t) + " has no area in UV";
            return std::nullopt;
        }
        surfaceArea += mesh.area(t);
        totalUvArea += std::abs(uvArea(mesh, t));
    }
    findIslands(mesh, layout);
    computeTangents(mesh, layout);
    layout.texelsPerMetre = static_cast<float>(resolution * std::sqrt(totalUvArea / surfaceArea));
    return layout;
}

} // namespace strandlight
