#include "engine/scene/atlas_cluster.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "engine/scene/atlas_fit.hpp"

namespace strandlight {

namespace {

constexpr float kFinestCell = 1.0f / 1024.0f; // of the scene's longest side
constexpr int kLevels = 11;                   // the last cell is the whole scene

struct Key
{
    glm::ivec3 cell{0};
    int facing = 0; // 0..5: +x -x +y -y +z -z
    bool operator<(const Key& o) const
    {
        return std::tie(facing, cell.x, cell.y, cell.z) <
               std::tie(o.facing, o.cell.x, o.cell.y, o.cell.z);
    }
};

glm::vec3 directionOf(const Chart& chart)
{
    return glm::cross(chart.axisU, chart.axisV);
}

int facingOf(glm::vec3 d)
{
    const glm::vec3 a = glm::abs(d);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return axis * 2 + (d[axis] < 0.0f ? 1 : 0);
}

Chart unite(const AtlasMesh& mesh, const std::vector<const Chart*>& parts)
{
    const auto largest =
        *std::max_element(parts.begin(), parts.end(), [](const Chart* a, const Chart* b) {
            return a->size.x * a->size.y < b->size.x * b->size.y;
        });
    std::vector<std::uint32_t> triangles;
    for (const Chart* part : parts)
        triangles.insert(triangles.end(), part->triangles.begin(), part->triangles.end());
    Chart chart = fitChart(mesh, std::move(triangles), directionOf(*largest));
    chart.pinned = true;
    return chart;
}

std::vector<Chart> clusterAt(const AtlasMesh& mesh, const std::vector<Chart>& charts,
                             glm::vec3 origin, float cell)
{
    std::map<Key, std::vector<const Chart*>> groups;
    std::vector<Chart> result;
    for (const Chart& chart : charts) {
        if (chart.size.x > cell) {
            result.push_back(chart);
            continue;
        }
        const glm::vec3 relative = (mesh.position(chart.triangles.front(), 0) - origin) / cell;
        groups[{glm::ivec3(glm::floor(relative)), facingOf(directionOf(chart))}].push_back(&chart);
    }
    for (const auto& [key, parts] : groups)
        result.push_back(parts.size() == 1 ? *parts.front() : unite(mesh, parts));
    return result;
}

} // namespace

std::vector<Chart> clusterSmallCharts(const AtlasMesh& mesh, std::vector<Chart> charts,
                                      std::size_t limit)
{
    const glm::vec3 origin = mesh.scene().boundsMin();
    const glm::vec3 extent = mesh.scene().boundsMax() - origin;
    float cell = std::max({extent.x, extent.y, extent.z}) * kFinestCell;
    std::vector<Chart> result = charts;
    for (int level = 0; level < kLevels && result.size() > limit; ++level, cell *= 2.0f)
        result = clusterAt(mesh, charts, origin, cell);
    return result;
}

} // namespace strandlight
