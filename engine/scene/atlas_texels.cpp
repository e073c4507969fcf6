#include "engine/scene/atlas_texels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strandlight {

namespace {

// Weights under this are rounding of corners that lie on texel centres.
constexpr double kLeastWeight = 1e-3;

// Samples keep this distance, in texels, from the border of their chart: exactly on it, a sample
// may lie in the plane of the next wall, and its rays start half outside the room.
constexpr double kInset = 0.1;

// Thin triangles are sampled only where nothing else is.
constexpr double kThinPenalty = 4.0;

// Two triangles of one chart overlap when both have the texel's centre this far inside, in texels.
constexpr double kOverlapMargin = 0.01;

double cross2(glm::dvec2 a, glm::dvec2 b)
{
    return a.x * b.y - a.y * b.x;
}

// Distance of a point from the nearest edge line, positive inside whatever the winding.
double depthInside(const UvTriangle& p, glm::dvec2 point)
{
    const double orientation = cross2(p[1] - p[0], p[2] - p[0]) < 0.0 ? -1.0 : 1.0;
    double depth = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2 edge = p[(i + 1) % 3] - p[i];
        const double length = glm::length(edge);
        if (!(length > 0.0))
            return 0.0;
        depth = std::min(depth, orientation * cross2(edge, point - p[i]) / length);
    }
    return depth;
}

struct Claim
{
    double rank = std::numeric_limits<double>::max(); // distance, plus the penalty
    std::uint32_t triangle = 0;
    NearestPoint point;
    bool taken = false;
    bool centreInside = false;
};

class TexelLister
{
public:
    TexelLister(const AtlasMesh& mesh, const AtlasLayout& layout, std::uint32_t resolution)
        : mesh_(mesh), layout_(layout), resolution_(static_cast<int>(resolution)),
          claims_(std::size_t(resolution) * resolution)
    {
    }

    TexelList list();

private:
    void addTriangle(std::uint32_t triangle);
    void claimTexel(std::uint32_t triangle, int x, int y);
    AtlasTexel finish(const Claim& claim, int x, int y) const;
    bool isNearBorder(std::uint32_t triangle, glm::dvec2 point) const;
    UvTriangle cornersOf(std::uint32_t triangle) const;

    const AtlasMesh& mesh_;
    const AtlasLayout& layout_;
    int resolution_;
    std::vector<Claim> claims_;
    std::string overlap_;
};

UvTriangle TexelLister::cornersOf(std::uint32_t triangle) const
{
    const AtlasCorner* c = &layout_.corners[std::size_t(triangle) * 3];
    return {glm::dvec2(c[0].uv), glm::dvec2(c[1].uv), glm::dvec2(c[2].uv)};
}

void TexelLister::claimTexel(std::uint32_t triangle, int x, int y)
{
    Claim& claim = claims_[static_cast<std::size_t>(y) * static_cast<std::size_t>(resolution_) +
                           static_cast<std::size_t>(x)];
    const glm::dvec2 centre(x + 0.5, y + 0.5);
    const UvTriangle& samples = layout_.sampleCorners[triangle];
    const bool inside = !mesh_.isThin(triangle) && depthInside(samples, centre) > kOverlapMargin;
    const std::uint32_t chart = layout_.chartOf[triangle];
    if (overlap_.empty() && claim.taken &&
        (layout_.chartOf[claim.triangle] != chart || (claim.centreInside && inside)))
        overlap_ = "triangles " + std::to_string(claim.triangle) + " and " +
                   std::to_string(triangle) + " share the texel (" + std::to_string(x) + ", " +
                   std::to_string(y) + ")";
    const NearestPoint point = nearestPoint(samples, centre);
    const double rank = point.distance + (mesh_.isThin(triangle) ? kThinPenalty : 0.0);
    claim.centreInside = claim.centreInside || inside;
    claim.taken = true;
    if (rank < claim.rank) {
        claim.rank = rank;
        claim.triangle = triangle;
        claim.point = point;
    }
}

void TexelLister::addTriangle(std::uint32_t triangle)
{
    const UvTriangle corners = cornersOf(triangle);
    const glm::dvec2 low = glm::min(corners[0], glm::min(corners[1], corners[2]));
    const glm::dvec2 high = glm::max(corners[0], glm::max(corners[1], corners[2]));
    const int xBegin = std::max(0, static_cast<int>(low.x - 0.5) - 1);
    const int yBegin = std::max(0, static_cast<int>(low.y - 0.5) - 1);
    const int xEnd = std::min(resolution_ - 1, static_cast<int>(high.x + 0.5));
    const int yEnd = std::min(resolution_ - 1, static_cast<int>(high.y + 0.5));
    for (int y = yBegin; y <= yEnd; ++y)
        for (int x = xBegin; x <= xEnd; ++x)
            if (touchesTexel(corners, x, y))
                claimTexel(triangle, x, y);
}

// An edge is a border unless a neighbour in the same chart has it at the same place.
bool TexelLister::isNearBorder(std::uint32_t triangle, glm::dvec2 point) const
{
    const UvTriangle& p = layout_.sampleCorners[triangle];
    for (std::uint32_t edge = 0; edge < 3; ++edge) {
        const glm::dvec2 start = p[edge];
        const glm::dvec2 along = p[(edge + 1) % 3] - start;
        const double length = glm::length(along);
        if (!(length > 0.0) || std::abs(cross2(along, point - start)) / length >= kInset)
            continue;
        const auto neighbours = mesh_.neighbours(triangle);
        const bool interior =
            std::any_of(neighbours.begin(), neighbours.end(), [&](const AtlasNeighbour& n) {
                const UvTriangle& q = layout_.sampleCorners[n.triangle];
                const std::uint32_t other = n.sameDirection ? n.otherEdge : (n.otherEdge + 1u) % 3;
                return n.edge == edge && !mesh_.isThin(n.triangle) &&
                       layout_.chartOf[n.triangle] == layout_.chartOf[triangle] &&
                       glm::distance(q[other], start) < 1e-3;
            });
        if (!interior)
            return true;
    }
    return false;
}

AtlasTexel TexelLister::finish(const Claim& claim, int x, int y) const
{
    const UvTriangle& p = layout_.sampleCorners[claim.triangle];
    glm::dvec2 weights = claim.point.barycentric;
    const glm::dvec2 point = p[0] + (p[1] - p[0]) * weights.x + (p[2] - p[0]) * weights.y;
    if (claim.point.distance > 0.0 || isNearBorder(claim.triangle, point)) {
        const double distance = glm::distance(point, (p[0] + p[1] + p[2]) / 3.0);
        const double step = distance > 2.0 * kInset ? kInset / distance : 0.5;
        weights += (glm::dvec2(1.0 / 3.0) - weights) * step;
    }
    return {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), claim.triangle,
            glm::vec2(weights), layout_.chartOf[claim.triangle]};
}

TexelList TexelLister::list()
{
    for (std::uint32_t t = 0; t < mesh_.triangleCount(); ++t)
        if (mesh_.area(t) > 0.0f)
            addTriangle(t);
    TexelList result;
    result.overlap = overlap_;
    for (int y = 0; y < resolution_; ++y) {
        for (int x = 0; x < resolution_; ++x) {
            const Claim& claim =
                claims_[static_cast<std::size_t>(y) * static_cast<std::size_t>(resolution_) +
                        static_cast<std::size_t>(x)];
            if (claim.taken)
                result.texels.push_back(finish(claim, x, y));
        }
    }
    return result;
}

} // namespace

// The support of a texel's weight is the open square of two texels around its centre; separating
// axes of that square and the triangle. Ericson. Real-Time Collision Detection. 2004, 5.2.9
bool touchesTexel(const UvTriangle& p, int x, int y)
{
    const glm::dvec2 centre(x + 0.5, y + 0.5);
    const double half = 1.0 - kLeastWeight;
    const auto separates = [&](glm::dvec2 axis) {
        const double a = glm::dot(p[0] - centre, axis);
        const double b = glm::dot(p[1] - centre, axis);
        const double c = glm::dot(p[2] - centre, axis);
        const double reach = half * (std::abs(axis.x) + std::abs(axis.y));
        return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
    };
    if (separates({1.0, 0.0}) || separates({0.0, 1.0}))
        return false;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2 edge = p[(i + 1) % 3] - p[i];
        if (separates({-edge.y, edge.x}))
            return false;
    }
    return true;
}

NearestPoint nearestPoint(const UvTriangle& p, glm::dvec2 point)
{
    const glm::dvec2 ab = p[1] - p[0];
    const glm::dvec2 ac = p[2] - p[0];
    const double area = cross2(ab, ac);
    if (std::abs(area) > 1e-12) {
        const glm::dvec2 weights(cross2(point - p[0], ac) / area, cross2(ab, point - p[0]) / area);
        if (weights.x >= 0.0 && weights.y >= 0.0 && weights.x + weights.y <= 1.0)
            return {weights, 0.0};
    }
    constexpr std::array<glm::dvec2, 3> kWeights = {glm::dvec2(0.0, 0.0), glm::dvec2(1.0, 0.0),
                                                    glm::dvec2(0.0, 1.0)};
    NearestPoint best{{0.0, 0.0}, std::numeric_limits<double>::max()};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        const glm::dvec2 edge = p[next] - p[i];
        const double squared = glm::dot(edge, edge);
        const double s =
            squared > 0.0 ? std::clamp(glm::dot(point - p[i], edge) / squared, 0.0, 1.0) : 0.0;
        const double distance = glm::distance(point, p[i] + edge * s);
        if (distance < best.distance)
            best = {kWeights[i] + (kWeights[next] - kWeights[i]) * s, distance};
    }
    return best;
}

TexelList listTexels(const AtlasMesh& mesh, const AtlasLayout& layout, std::uint32_t resolution)
{
    return TexelLister(mesh, layout, resolution).list();
}

} // namespace strandlight
