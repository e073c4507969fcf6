#include "engine/scene/atlas_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace strandlight {

namespace {

constexpr std::size_t kMaximumAngles = 128;

// A cell counts as covered when its centre is at least this far inside, in cells: neighbours share
// edges, not cells.
constexpr double kFoldMargin = 0.05;

struct PlaneFrame
{
    glm::dvec3 u;
    glm::dvec3 v;
    glm::dvec2 project(glm::vec3 p) const
    {
        return {glm::dot(u, glm::dvec3(p)), glm::dot(v, glm::dvec3(p))};
    }
};

PlaneFrame makeFrame(glm::vec3 direction)
{
    const glm::dvec3 w = glm::normalize(glm::dvec3(direction));
    const glm::dvec3 helper =
        std::abs(w.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 u = glm::normalize(glm::cross(helper, w));
    return {u, glm::cross(w, u)};
}

double cross2(glm::dvec2 a, glm::dvec2 b)
{
    return a.x * b.y - a.y * b.x;
}

// Andrew's monotone chain, counter-clockwise.
std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points)
{
    std::sort(points.begin(), points.end(),
              [](glm::dvec2 a, glm::dvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3)
        return points;
    std::vector<glm::dvec2> hull(points.size() * 2);
    std::size_t size = 0;
    const auto add = [&](glm::dvec2 p, std::size_t least) {
        while (size >= least && cross2(hull[size - 1] - hull[size - 2], p - hull[size - 2]) <= 0.0)
            --size;
        hull[size++] = p;
    };
    for (const glm::dvec2 p : points)
        add(p, 2);
    const std::size_t lower = size + 1;
    for (std::size_t i = points.size() - 1; i-- > 0;)
        add(points[i], lower);
    hull.resize(size - 1);
    return hull;
}

// Directions worth trying: of the hull's edges (one of them is best), thinned out when there are
// many.
std::vector<glm::dvec2> candidateDirections(const std::vector<glm::dvec2>& hull)
{
    std::vector<glm::dvec2> directions;
    const std::size_t step = hull.size() / kMaximumAngles + 1;
    for (std::size_t i = 0; i < hull.size(); i += step) {
        const glm::dvec2 edge = hull[(i + 1) % hull.size()] - hull[i];
        const double length = glm::length(edge);
        if (length > 0.0)
            directions.push_back(edge / length);
    }
    if (directions.empty())
        directions.emplace_back(1.0, 0.0);
    return directions;
}

struct Rectangle
{
    glm::dvec2 u{1.0, 0.0};
    glm::dvec2 minimum{0.0};
    glm::dvec2 size{0.0};
};

Rectangle boundAlong(const std::vector<glm::dvec2>& hull, glm::dvec2 u)
{
    const glm::dvec2 v(-u.y, u.x);
    glm::dvec2 low(std::numeric_limits<double>::max());
    glm::dvec2 high(std::numeric_limits<double>::lowest());
    for (const glm::dvec2 p : hull) {
        const glm::dvec2 q(glm::dot(p, u), glm::dot(p, v));
        low = glm::min(low, q);
        high = glm::max(high, q);
    }
    return {u, low, high - low};
}

Rectangle smallestRectangle(const std::vector<glm::dvec2>& hull)
{
    Rectangle best;
    double bestArea = std::numeric_limits<double>::max();
    for (const glm::dvec2 u : candidateDirections(hull)) {
        const Rectangle candidate = boundAlong(hull, u);
        const double area = candidate.size.x * candidate.size.y;
        // Equal up to rounding is not better: the choice must not hang on the last bit.
        if (area < bestArea * (1.0 - 1e-9)) {
            best = candidate;
            bestArea = area;
        }
    }
    if (best.size.x < best.size.y)
        best = boundAlong(hull, glm::dvec2(-best.u.y, best.u.x));
    return best;
}

class FoldRaster
{
public:
    FoldRaster(glm::dvec2 low, glm::dvec2 size, std::size_t triangleCount)
    {
        const double longest = std::max(size.x, size.y);
        const double cells =
            std::clamp(24.0 * std::sqrt(static_cast<double>(triangleCount)), 32.0, 512.0);
        scale_ = longest > 0.0 ? cells / longest : 1.0;
        low_ = low;
        width_ = static_cast<int>(size.x * scale_) + 1;
        height_ = static_cast<int>(size.y * scale_) + 1;
        covered_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
                        false);
    }

    // False, and nothing changes, when the triangle meets a covered cell or faces away.
    bool claim(std::array<glm::dvec2, 3> p)
    {
        for (glm::dvec2& q : p)
            q = (q - low_) * scale_;
        if (cross2(p[1] - p[0], p[2] - p[0]) <= 0.0)
            return false;
        cells_.clear();
        collectCells(p);
        const bool clash =
            std::any_of(cells_.begin(), cells_.end(), [&](std::size_t i) { return covered_[i]; });
        if (!clash)
            for (const std::size_t i : cells_)
                covered_[i] = true;
        return !clash;
    }

private:
    void collectCells(const std::array<glm::dvec2, 3>& p)
    {
        std::array<glm::dvec2, 3> normals{};
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 edge = p[(i + 1) % 3] - p[i];
            normals[i] = glm::dvec2(-edge.y, edge.x) / std::max(glm::length(edge), 1e-30);
        }
        const glm::dvec2 low = glm::min(p[0], glm::min(p[1], p[2]));
        const glm::dvec2 high = glm::max(p[0], glm::max(p[1], p[2]));
        const int yEnd = std::min(height_ - 1, static_cast<int>(high.y));
        const int xEnd = std::min(width_ - 1, static_cast<int>(high.x));
        for (int y = std::max(0, static_cast<int>(low.y)); y <= yEnd; ++y) {
            for (int x = std::max(0, static_cast<int>(low.x)); x <= xEnd; ++x) {
                const glm::dvec2 centre(x + 0.5, y + 0.5);
                bool inside = true;
                for (std::size_t i = 0; i < 3; ++i)
                    inside = inside && glm::dot(centre - p[i], normals[i]) > kFoldMargin;
                if (inside)
                    cells_.push_back(static_cast<std::size_t>(y) *
                                         static_cast<std::size_t>(width_) +
                                     static_cast<std::size_t>(x));
            }
        }
    }

    double scale_ = 1.0;
    glm::dvec2 low_{0.0};
    int width_ = 0;
    int height_ = 0;
    std::vector<bool> covered_;
    std::vector<std::size_t> cells_;
};

} // namespace

Chart fitChart(const AtlasMesh& mesh, std::vector<std::uint32_t> triangles, glm::vec3 direction)
{
    const PlaneFrame frame = makeFrame(direction);
    std::vector<glm::dvec2> points;
    points.reserve(triangles.size() * 3);
    for (const std::uint32_t t : triangles)
        for (std::uint32_t c = 0; c < 3; ++c)
            points.push_back(frame.project(mesh.position(t, c)));
    const Rectangle rectangle = smallestRectangle(convexHull(std::move(points)));

    Chart chart;
    chart.triangles = std::move(triangles);
    chart.axisU = glm::vec3(frame.u * rectangle.u.x + frame.v * rectangle.u.y);
    chart.axisV = glm::vec3(-frame.u * rectangle.u.y + frame.v * rectangle.u.x);

    // The stored axes are rounded; bounds are taken along them, so coordinates stay within [0,
    // size].
    glm::vec2 low(std::numeric_limits<float>::max());
    glm::vec2 high(std::numeric_limits<float>::lowest());
    for (const std::uint32_t t : chart.triangles) {
        for (std::uint32_t c = 0; c < 3; ++c) {
            const glm::vec2 q = chartCoordinates(chart, mesh.position(t, c));
            low = glm::min(low, q);
            high = glm::max(high, q);
        }
    }
    chart.minimum = low;
    chart.size = high - low;
    return chart;
}

std::vector<std::uint32_t> removeFolds(const AtlasMesh& mesh, std::vector<std::uint32_t>& triangles,
                                       glm::vec3 direction)
{
    if (triangles.size() < 2)
        return {};
    const PlaneFrame frame = makeFrame(direction);
    const auto corners = [&](std::uint32_t t) {
        return std::array{frame.project(mesh.position(t, 0)), frame.project(mesh.position(t, 1)),
                          frame.project(mesh.position(t, 2))};
    };
    glm::dvec2 low(std::numeric_limits<double>::max());
    glm::dvec2 high(std::numeric_limits<double>::lowest());
    for (const std::uint32_t t : triangles) {
        for (const glm::dvec2 p : corners(t)) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    FoldRaster raster(low, high - low, triangles.size());
    std::vector<std::uint32_t> kept;
    std::vector<std::uint32_t> rejected;
    for (const std::uint32_t t : triangles) {
        const bool fits = raster.claim(corners(t));
        (fits || kept.empty() ? kept : rejected).push_back(t);
    }
    triangles = std::move(kept);
    return rejected;
}

} // namespace strandlight
