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

float areaOf(const Chart& chart)
{
    return chart.size.x * chart.size.y;
}

Chart unite(const AtlasMesh& mesh, const std::vector<const Chart*>& parts)
{
    const auto largest =
        *std::max_element(parts.begin(), parts.end(),
                          [](const Chart* a, const Chart* b) { return areaOf(*a) < areaOf(*b); });
    std::vector<std::uint32_t> triangles;
    for (const Chart* part : parts)
        triangles.insert(triangles.end(), part->triangles.begin(), part->triangles.end());
    Chart chart = fitChart(mesh, std::move(triangles), directionOf(*largest));
    chart.pinned = true;
    return chart;
}

struct Grouping
{
    std::vector<const Chart*> alone; // too large to be united
    std::map<Key, std::vector<const Chart*>> groups;

    std::size_t count() const { return alone.size() + groups.size(); }
};

// Charts no longer than a cell and no larger than `area`, by cell and direction.
Grouping groupCharts(const AtlasMesh& mesh, const std::vector<Chart>& charts, glm::vec3 origin,
                     float cell, float area)
{
    Grouping grouping;
    for (const Chart& chart : charts) {
        if (chart.size.x > cell || areaOf(chart) > area) {
            grouping.alone.push_back(&chart);
            continue;
        }
        const glm::vec3 relative = (mesh.position(chart.triangles.front(), 0) - origin) / cell;
        grouping.groups[{glm::ivec3(glm::floor(relative)), facingOf(directionOf(chart))}].push_back(
            &chart);
    }
    return grouping;
}

// The smallest area up to which charts must be united in these cells, that no more than `limit` are
// left; the largest one there is when all must be.
float smallestAreaToUnite(const AtlasMesh& mesh, const std::vector<Chart>& charts, glm::vec3 origin,
                          float cell, std::size_t limit)
{
    std::vector<float> areas;
    for (const Chart& chart : charts)
        areas.push_back(areaOf(chart));
    std::sort(areas.begin(), areas.end());
    const auto first = std::partition_point(areas.begin(), std::prev(areas.end()), [&](float area) {
        return groupCharts(mesh, charts, origin, cell, area).count() > limit;
    });
    return *first;
}

} // namespace

std::vector<Chart> clusterSmallCharts(const AtlasMesh& mesh, std::vector<Chart> charts,
                                      std::size_t limit)
{
    if (charts.size() <= limit)
        return charts;
    const glm::vec3 origin = mesh.scene().boundsMin();
    const glm::vec3 extent = mesh.scene().boundsMax() - origin;
    float cell = std::max({extent.x, extent.y, extent.z}) * kFinestCell;
    for (int level = 1; level < kLevels; ++level, cell *= 2.0f)
        if (groupCharts(mesh, charts, origin, cell, HUGE_VALF).count() <= limit)
            break;
    // In cells as large as needed the smallest are enough: a wall is no longer than a cell, either.
    const float area = smallestAreaToUnite(mesh, charts, origin, cell, limit);
    const Grouping grouping = groupCharts(mesh, charts, origin, cell, area);
    std::vector<Chart> result;
    for (const Chart* chart : grouping.alone)
        result.push_back(*chart);
    for (const auto& [key, parts] : grouping.groups)
        result.push_back(parts.size() == 1 ? *parts.front() : unite(mesh, parts));
    return result;
}

} // namespace strandlight
