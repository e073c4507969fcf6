// Grows charts from large triangles over shared edges, bounded by face normals and by creases of
// the shading normal; triangles that would fold over the chart are given back. After the greedy
// atlas generators, e.g. Sander et al. Texture Mapping Progressive Meshes. 2001; Levy et al. Least
// Squares Conformal Maps. 2002 (ours projects onto planes, which keeps the tangent frame constant
// over a chart).
#include "engine/scene/atlas_charts.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

#include "engine/scene/atlas_fit.hpp"

namespace strandlight {

namespace {

constexpr std::uint32_t kUnassigned = ~0u;

// Projected areas shrink by at most the cosine of the cone: 50 degrees keeps two thirds.
constexpr float kConeCosine = 0.6428f;

// Lobes are stored in the shading frame and interpolated between texels, so a frame must not turn
// by more than 35 degrees across an edge inside a chart.
constexpr float kCreaseCosine = 0.8192f;

// A chart whose rectangle wastes more than this part of the scene's surface is halved.
constexpr double kWasteLimit = 0.002;
constexpr double kFillLimit = 0.5;

class ChartBuilder
{
public:
    explicit ChartBuilder(const AtlasMesh& mesh)
        : mesh_(mesh), chartOf_(mesh.triangleCount(), kUnassigned)
    {
    }

    std::vector<Chart> build();

private:
    std::vector<std::uint32_t> seedOrder() const;
    std::vector<std::uint32_t> grow(std::uint32_t seed);
    bool isSmooth(std::uint32_t triangle, const AtlasNeighbour& neighbour) const;
    void attachThinTriangles();
    void addChart(std::vector<std::uint32_t> triangles, glm::vec3 direction);
    glm::vec3 projectionDirection(const std::vector<std::uint32_t>& triangles) const;

    const AtlasMesh& mesh_;
    double totalArea_ = 0.0;
    std::vector<std::uint32_t> chartOf_; // [triangle]
    std::vector<Chart> charts_;
};

std::vector<std::uint32_t> ChartBuilder::seedOrder() const
{
    std::vector<std::uint32_t> order(mesh_.triangleCount());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return mesh_.area(a) > mesh_.area(b);
    });
    return order;
}

// The shading normals agree at both ends of the shared edge.
bool ChartBuilder::isSmooth(std::uint32_t triangle, const AtlasNeighbour& neighbour) const
{
    if (neighbour.sameDirection)
        return false;
    for (std::uint32_t end = 0; end < 2; ++end) {
        // The neighbour runs along the edge the other way.
        const glm::vec3 a = mesh_.shadingNormal(triangle, (neighbour.edge + end) % 3);
        const glm::vec3 b =
            mesh_.shadingNormal(neighbour.triangle, (neighbour.otherEdge + 1 - end) % 3);
        if (glm::dot(a, b) < kCreaseCosine)
            return false;
    }
    return true;
}

// Triangles reachable from the seed within its normal cone, nearest first.
std::vector<std::uint32_t> ChartBuilder::grow(std::uint32_t seed)
{
    const std::uint32_t id = static_cast<std::uint32_t>(charts_.size());
    std::vector<std::uint32_t> members{seed};
    chartOf_[seed] = id;
    for (std::size_t next = 0; next < members.size(); ++next) {
        const std::uint32_t triangle = members[next];
        for (const AtlasNeighbour& neighbour : mesh_.neighbours(triangle)) {
            const std::uint32_t other = neighbour.triangle;
            const bool free = chartOf_[other] == kUnassigned && !mesh_.isThin(other);
            if (!free || glm::dot(mesh_.normal(other), mesh_.normal(seed)) < kConeCosine ||
                !isSmooth(triangle, neighbour))
                continue;
            chartOf_[other] = id;
            members.push_back(other);
        }
    }
    return members;
}

// The mean normal, unless some triangle would be seen too flat from it; then the seed's.
glm::vec3 ChartBuilder::projectionDirection(const std::vector<std::uint32_t>& triangles) const
{
    glm::dvec3 sum(0.0);
    for (const std::uint32_t t : triangles)
        sum += glm::dvec3(mesh_.normal(t)) * static_cast<double>(mesh_.area(t));
    const glm::vec3 seed = mesh_.normal(triangles.front());
    if (!(glm::dot(sum, sum) > 0.0))
        return seed;
    const auto mean = glm::vec3(glm::normalize(sum));
    const bool usable = std::all_of(triangles.begin(), triangles.end(), [&](std::uint32_t t) {
        return glm::dot(mesh_.normal(t), mean) >= kConeCosine;
    });
    return usable ? mean : seed;
}

// Fits the rectangle; a chart that fills little of it (a frame around a window) is cut in two.
void ChartBuilder::addChart(std::vector<std::uint32_t> triangles, glm::vec3 direction)
{
    Chart chart = fitChart(mesh_, std::move(triangles), direction);
    double projectedArea = 0.0;
    for (const std::uint32_t t : chart.triangles)
        projectedArea += mesh_.area(t) * std::abs(glm::dot(mesh_.normal(t), direction));
    const double rectangle = static_cast<double>(chart.size.x) * chart.size.y;
    const bool wasteful = rectangle - projectedArea > kWasteLimit * totalArea_ &&
                          projectedArea < kFillLimit * rectangle;
    if (wasteful && chart.triangles.size() > 1) {
        const auto isRight = [&](std::uint32_t t) {
            const glm::vec3 sum =
                mesh_.position(t, 0) + mesh_.position(t, 1) + mesh_.position(t, 2);
            return chartCoordinates(chart, sum / 3.0f).x > 0.5f * chart.size.x;
        };
        std::vector<std::uint32_t> left;
        std::vector<std::uint32_t> right;
        for (const std::uint32_t t : chart.triangles)
            (isRight(t) ? right : left).push_back(t);
        if (!left.empty() && !right.empty()) {
            addChart(std::move(left), direction);
            addChart(std::move(right), direction);
            return;
        }
    }
    for (const std::uint32_t t : chart.triangles)
        chartOf_[t] = static_cast<std::uint32_t>(charts_.size());
    charts_.push_back(std::move(chart));
}

// A thin triangle lies on an edge of its neighbour, so it fits that chart wherever that is.
void ChartBuilder::attachThinTriangles()
{
    std::deque<std::uint32_t> queue;
    for (std::uint32_t t = 0; t < mesh_.triangleCount(); ++t)
        if (!mesh_.isThin(t))
            queue.push_back(t);
    std::vector<bool> changed(charts_.size(), false);
    for (; !queue.empty(); queue.pop_front()) {
        for (const AtlasNeighbour& neighbour : mesh_.neighbours(queue.front())) {
            if (!mesh_.isThin(neighbour.triangle) || chartOf_[neighbour.triangle] != kUnassigned)
                continue;
            const std::uint32_t chart = chartOf_[queue.front()];
            chartOf_[neighbour.triangle] = chart;
            charts_[chart].triangles.push_back(neighbour.triangle);
            changed[chart] = true;
            queue.push_back(neighbour.triangle);
        }
    }
    for (std::size_t i = 0; i < charts_.size(); ++i)
        if (changed[i])
            charts_[i] = fitChart(mesh_, std::move(charts_[i].triangles),
                                  glm::cross(charts_[i].axisU, charts_[i].axisV));
}

std::vector<Chart> ChartBuilder::build()
{
    for (std::uint32_t t = 0; t < mesh_.triangleCount(); ++t)
        totalArea_ += mesh_.area(t);
    for (const std::uint32_t seed : seedOrder()) {
        if (mesh_.isThin(seed))
            continue;
        while (chartOf_[seed] == kUnassigned) {
            std::vector<std::uint32_t> members = grow(seed);
            const glm::vec3 direction = projectionDirection(members);
            const std::vector<std::uint32_t> rejected = removeFolds(mesh_, members, direction);
            for (const std::uint32_t t : rejected)
                chartOf_[t] = kUnassigned;
            addChart(std::move(members), direction);
        }
    }
    attachThinTriangles();
    return std::move(charts_);
}

} // namespace

glm::vec2 chartCoordinates(const Chart& chart, glm::vec3 position)
{
    return glm::vec2(glm::dot(position, chart.axisU), glm::dot(position, chart.axisV)) -
           chart.minimum;
}

std::vector<Chart> buildCharts(const AtlasMesh& mesh)
{
    return ChartBuilder(mesh).build();
}

} // namespace strandlight
