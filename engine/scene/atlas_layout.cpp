// Chart packing: skyline bottom-left by stb_rect_pack, scale by bisection.
// Jylänki. A Thousand Ways to Pack the Bin. 2010
#include "engine/scene/atlas_layout.hpp"

#include <algorithm>
#include <cmath>

#define STBRP_STATIC
#define STB_RECT_PACK_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_rect_pack.h>
#pragma GCC diagnostic pop

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"

namespace strandlight {

namespace {

constexpr int kBisectionSteps = 18; // scale to 1e-5 of its bound

// A chart takes (steps + 1) texels: its border runs through the centres of the outermost ones.
struct Placement
{
    glm::uvec2 origin{0};
    glm::uvec2 steps{0};
};

// Size in texels, rounded so that both borders meet texel centres; 0: all points at one centre.
glm::uvec2 stepsOf(const Chart& chart, double scale)
{
    if (chart.pinned)
        return glm::uvec2(0);
    return {static_cast<std::uint32_t>(chart.size.x * scale + 0.5),
            static_cast<std::uint32_t>(chart.size.y * scale + 0.5)};
}

class Packer
{
public:
    Packer(const std::vector<Chart>& charts, const AtlasSettings& settings)
        : charts_(charts), settings_(settings), side_(settings.resolution + settings.gutter),
          nodes_(side_)
    {
    }

    // False when the charts do not fit at `scale` texels per metre; then placements() is undefined.
    bool tryScale(double scale);
    const std::vector<Placement>& placements() const { return placements_; }

private:
    // Charts of a single texel read no other texel: they are packed as one block, side by side.
    struct SingleBlock
    {
        std::vector<std::uint32_t> charts;
        std::uint32_t width = 0;
        std::uint32_t height = 0;
    };
    SingleBlock collectSingles() const;
    bool addRectangle(std::uint32_t id, std::uint32_t width, std::uint32_t height);

    const std::vector<Chart>& charts_;
    const AtlasSettings& settings_;
    std::uint32_t side_;
    std::vector<stbrp_node> nodes_;
    std::vector<stbrp_rect> rectangles_;
    std::vector<Placement> placements_; // [chart]
};

Packer::SingleBlock Packer::collectSingles() const
{
    SingleBlock block;
    for (std::uint32_t i = 0; i < charts_.size(); ++i)
        if (placements_[i].steps == glm::uvec2(0))
            block.charts.push_back(i);
    const auto count = static_cast<std::uint32_t>(block.charts.size());
    if (count == 0)
        return block;
    block.width = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    block.height = (count + block.width - 1) / block.width;
    return block;
}

bool Packer::addRectangle(std::uint32_t id, std::uint32_t width, std::uint32_t height)
{
    if (width > settings_.resolution || height > settings_.resolution)
        return false;
    stbrp_rect rectangle{};
    rectangle.id = static_cast<int>(id);
    rectangle.w = static_cast<stbrp_coord>(width + settings_.gutter);
    rectangle.h = static_cast<stbrp_coord>(height + settings_.gutter);
    rectangles_.push_back(rectangle);
    return true;
}

bool Packer::tryScale(double scale)
{
    placements_.assign(charts_.size(), {});
    rectangles_.clear();
    std::uint64_t texels = 0;
    for (std::uint32_t i = 0; i < charts_.size(); ++i) {
        const glm::uvec2 steps = stepsOf(charts_[i], scale);
        placements_[i].steps = steps;
        texels += (std::uint64_t(steps.x) + 1) * (std::uint64_t(steps.y) + 1);
        if (steps != glm::uvec2(0) && !addRectangle(i, steps.x + 1, steps.y + 1))
            return false;
    }
    if (texels > std::uint64_t(settings_.resolution) * settings_.resolution)
        return false;
    const SingleBlock block = collectSingles();
    const auto blockId = static_cast<std::uint32_t>(charts_.size());
    if (!block.charts.empty() && !addRectangle(blockId, block.width, block.height))
        return false;

    stbrp_context context;
    stbrp_init_target(&context, static_cast<int>(side_), static_cast<int>(side_), nodes_.data(),
                      static_cast<int>(nodes_.size()));
    if (!stbrp_pack_rects(&context, rectangles_.data(), static_cast<int>(rectangles_.size())))
        return false;
    for (const stbrp_rect& rectangle : rectangles_) {
        const glm::uvec2 origin(rectangle.x, rectangle.y);
        if (static_cast<std::uint32_t>(rectangle.id) != blockId) {
            placements_[static_cast<std::uint32_t>(rectangle.id)].origin = origin;
            continue;
        }
        for (std::uint32_t i = 0; i < block.charts.size(); ++i)
            placements_[block.charts[i]].origin =
                origin + glm::uvec2(i % block.width, i / block.width);
    }
    return true;
}

double findLargestScale(Packer& packer, const std::vector<Chart>& charts,
                        const AtlasSettings& settings)
{
    if (!packer.tryScale(0.0))
        throw Error("atlas: " + std::to_string(charts.size()) + " charts need more than the " +
                    std::to_string(settings.resolution) + " x " +
                    std::to_string(settings.resolution) +
                    " texels there are; raise the resolution");
    double area = 0.0;
    float longest = 0.0f;
    for (const Chart& chart : charts) {
        if (chart.pinned)
            continue;
        area += static_cast<double>(chart.size.x) * chart.size.y;
        longest = std::max(longest, chart.size.x);
    }
    // Above either bound the charts cannot fit: their areas, and the length of the longest.
    const double resolution = settings.resolution;
    if (!(longest > 0.0f))
        return 0.0;
    double failing = (resolution + 1.0) / longest;
    if (area > 0.0)
        failing = std::min(failing, 2.0 * resolution / std::sqrt(area));
    double fitting = 0.0;
    for (int i = 0; i < kBisectionSteps; ++i) {
        const double middle = 0.5 * (fitting + failing);
        (packer.tryScale(middle) ? fitting : failing) = middle;
    }
    STRANDLIGHT_ASSERT(packer.tryScale(fitting));
    return fitting;
}

// One coordinate: over `steps` texels, or all at the centre. A sample keeps half a texel of width
// in that case.
double place(std::uint32_t origin, std::uint32_t steps, double fraction, bool forSample)
{
    const double start = origin + 0.5;
    if (steps > 0)
        return start + steps * fraction;
    return forSample ? start + 0.5 * (fraction - 0.5) : start;
}

double fractionOf(float value, float size)
{
    return size > 0.0f ? std::clamp(static_cast<double>(value) / size, 0.0, 1.0) : 0.5;
}

void placeTriangle(const AtlasMesh& mesh, const Chart& chart, const Placement& placement,
                   std::uint32_t triangle, AtlasLayout& layout)
{
    for (std::uint32_t c = 0; c < 3; ++c) {
        const glm::vec2 local = chartCoordinates(chart, mesh.position(triangle, c));
        const glm::dvec2 f(fractionOf(local.x, chart.size.x), fractionOf(local.y, chart.size.y));
        AtlasCorner& corner = layout.corners[std::size_t(triangle) * 3 + c];
        corner.uv = glm::vec2(place(placement.origin.x, placement.steps.x, f.x, false),
                              place(placement.origin.y, placement.steps.y, f.y, false));
        corner.tangent = chart.axisU;
        layout.sampleCorners[triangle][c] =
            glm::dvec2(place(placement.origin.x, placement.steps.x, f.x, true),
                       place(placement.origin.y, placement.steps.y, f.y, true));
    }
}

} // namespace

AtlasLayout packCharts(const AtlasMesh& mesh, const std::vector<Chart>& charts,
                       const AtlasSettings& settings)
{
    Packer packer(charts, settings);
    const double scale = findLargestScale(packer, charts, settings);

    AtlasLayout layout;
    layout.chartCount = static_cast<std::uint32_t>(charts.size());
    layout.texelsPerMetre = static_cast<float>(scale);
    layout.chartOf.assign(mesh.triangleCount(), 0);
    layout.sampleCorners.resize(mesh.triangleCount());

    // Triangles without area and without neighbours are in no chart and never seen; they get a
    // valid place.
    const Placement& first = packer.placements().front();
    const AtlasCorner somewhere{glm::vec2(first.origin) + 0.5f, charts.front().axisU};
    layout.corners.assign(std::size_t(mesh.triangleCount()) * 3, somewhere);
    layout.sampleCorners.assign(
        mesh.triangleCount(),
        {glm::dvec2(somewhere.uv), glm::dvec2(somewhere.uv), glm::dvec2(somewhere.uv)});
    for (std::uint32_t i = 0; i < charts.size(); ++i) {
        for (const std::uint32_t triangle : charts[i].triangles) {
            layout.chartOf[triangle] = i;
            placeTriangle(mesh, charts[i], packer.placements()[i], triangle, layout);
        }
    }
    return layout;
}

} // namespace strandlight
