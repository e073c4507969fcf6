// Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007 (binning)
#include "engine/scene/bvh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"

namespace strandlight {
namespace {

constexpr int kBins = 16;
// Cost of a triangle test against a node. Three fetches against one, but a smaller tree stays in
// the cache: of 0.5, 1 and 2 the middle was fastest on lavapipe, by 5 %.
constexpr float kTriangleCost = 1.0f;
// Deeper than this, ranges are halved by count, so recursion stays bounded for any input.
constexpr std::uint32_t kSahDepth = 48;
// Products of two coordinates must stay finite in fp32.
constexpr float kFarthest = 1e15f;

struct Box
{
    glm::vec3 low = glm::vec3(std::numeric_limits<float>::max());
    glm::vec3 high = glm::vec3(std::numeric_limits<float>::lowest());

    void add(const Box& other)
    {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    void add(glm::vec3 point)
    {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    // Half the surface area, in double: huge scenes must not overflow.
    double area() const
    {
        if (high.x < low.x)
            return 0.0;
        const glm::dvec3 e = glm::dvec3(high) - glm::dvec3(low);
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
};

struct Reference
{
    Box box;
    glm::vec3 centre;
    std::uint32_t triangle;
};

struct BuildNode
{
    Box box;
    std::uint32_t left = 0; // children left, right; leaves: count > 0
    std::uint32_t right = 0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    int axis = 0;
};

struct Split
{
    int axis = -1;
    int bin = 0;
    double cost = std::numeric_limits<double>::max();
};

int binOf(float centre, float low, float high)
{
    const float position = (centre - low) / (high - low) * float(kBins);
    return std::clamp(int(position), 0, kBins - 1);
}

class Builder
{
public:
    explicit Builder(std::vector<Reference> references) : references_(std::move(references)) {}

    void run()
    {
        if (!references_.empty())
            build(0, std::uint32_t(references_.size()), 0);
    }

    std::vector<BuildNode> nodes;
    std::uint32_t depth = 0;
    const std::vector<Reference>& references() const { return references_; }

private:
    std::uint32_t build(std::uint32_t first, std::uint32_t count, std::uint32_t level);
    Split findSplit(std::uint32_t first, std::uint32_t count, const Box& centres) const;
    std::uint32_t partition(std::uint32_t first, std::uint32_t count, const Split& split,
                            const Box& centres);

    std::vector<Reference> references_;
};

Split Builder::findSplit(std::uint32_t first, std::uint32_t count, const Box& centres) const
{
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
        const float low = centres.low[axis];
        const float high = centres.high[axis];
        if (!(high > low))
            continue;
        std::array<Box, kBins> boxes;
        std::array<std::uint32_t, kBins> counts{};
        for (std::uint32_t i = first; i < first + count; ++i) {
            const auto bin = std::size_t(binOf(references_[i].centre[axis], low, high));
            boxes[bin].add(references_[i].box);
            ++counts[bin];
        }
        // Cost right of each plane, then sweep from the left.
        std::array<double, kBins> right{};
        Box box;
        std::uint32_t n = 0;
        for (std::size_t bin = kBins - 1; bin > 0; --bin) {
            box.add(boxes[bin]);
            n += counts[bin];
            right[bin] = box.area() * n;
        }
        box = Box();
        n = 0;
        for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
            box.add(boxes[bin]);
            n += counts[bin];
            const double cost = box.area() * n + right[bin + 1];
            if (n > 0 && n < count && cost < best.cost)
                best = {axis, int(bin), cost};
        }
    }
    return best;
}

std::uint32_t Builder::partition(std::uint32_t first, std::uint32_t count, const Split& split,
                                 const Box& centres)
{
    const auto begin = references_.begin() + first;
    const auto end = begin + count;
    if (split.axis >= 0) {
        const float low = centres.low[split.axis];
        const float high = centres.high[split.axis];
        const auto middle = std::stable_partition(begin, end, [&](const Reference& r) {
            return binOf(r.centre[split.axis], low, high) <= split.bin;
        });
        return std::uint32_t(middle - begin);
    }
    return count / 2;
}

std::uint32_t Builder::build(std::uint32_t first, std::uint32_t count, std::uint32_t level)
{
    const auto index = std::uint32_t(nodes.size());
    nodes.emplace_back();
    Box box;
    Box centres;
    for (std::uint32_t i = first; i < first + count; ++i) {
        box.add(references_[i].box);
        centres.add(references_[i].centre);
    }
    Split split = level < kSahDepth ? findSplit(first, count, centres) : Split{};
    const double leafCost = box.area() * count * kTriangleCost;
    const double splitCost = 2.0 * box.area() + split.cost * kTriangleCost;
    if (count <= gpu::kLeafTriangles && (split.axis < 0 || leafCost <= splitCost)) {
        nodes[index] = {box, 0, 0, first, count, 0};
        depth = std::max(depth, level);
        return index;
    }
    const std::uint32_t leftCount = partition(first, count, split, centres);
    STRANDLIGHT_ASSERT(leftCount > 0 && leftCount < count);
    const std::uint32_t left = build(first, leftCount, level + 1);
    const std::uint32_t right = build(first + leftCount, count - leftCount, level + 1);
    nodes[index] = {box, left, right, 0, 0, std::max(split.axis, 0)};
    return index;
}

std::vector<Reference> makeReferences(const Scene& scene)
{
    std::vector<Reference> references;
    references.reserve(scene.triangles.size());
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        Reference reference;
        for (int corner = 0; corner < 3; ++corner) {
            const glm::vec3 p = scene.vertices[scene.triangles[i][corner]].position;
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                throw Error("triangle " + std::to_string(i) + ", corner " + std::to_string(corner) +
                            ": position is not finite");
            if (glm::any(glm::greaterThan(glm::abs(p), glm::vec3(kFarthest))))
                throw Error("triangle " + std::to_string(i) + ", corner " + std::to_string(corner) +
                            ": position is farther than 1e15 m from the origin");
            reference.box.add(p);
        }
        reference.centre = 0.5f * reference.box.low + 0.5f * reference.box.high;
        reference.triangle = std::uint32_t(i);
        references.push_back(reference);
    }
    return references;
}

// 65533 steps span the scene, one spare step on either side.
struct Quantizer
{
    glm::vec3 origin; // fp32: the ray's side knows no other
    glm::dvec3 step;

    std::uint32_t interval(float low, float high, int axis) const
    {
        // One step of slack covers the rounding of the ray's side of the slab test.
        const double a = std::floor((double(low) - double(origin[axis])) / step[axis]) - 1.0;
        const double b = std::ceil((double(high) - double(origin[axis])) / step[axis]) + 1.0;
        const auto qa = std::uint32_t(std::clamp(a, 0.0, 65535.0));
        const auto qb = std::uint32_t(std::clamp(b, 0.0, 65535.0));
        return qa | (qb << 16u);
    }
};

Quantizer makeQuantizer(const Box& box)
{
    const glm::dvec3 extent = glm::dvec3(box.high) - glm::dvec3(box.low);
    const double longest = std::max({extent.x, extent.y, extent.z, 1e-30});
    // A flat scene still needs a grid that a ray can cross.
    const glm::dvec3 step = glm::max(extent, glm::dvec3(longest * 1e-4)) / 65529.0;
    // Subtracted in fp32: of dvec3(vec3(double)) GCC 12 at -O3 leaves the rounding out.
    return {box.low - glm::vec3(2.0 * step), step};
}

// Depth-first order of one octant: the child nearer to a ray of these signs comes first.
void emitOctant(const std::vector<BuildNode>& tree, const Quantizer& quantizer,
                std::uint32_t octant, std::uint32_t index, std::vector<glm::uvec4>& out)
{
    const BuildNode& node = tree[index];
    const std::size_t place = out.size();
    glm::uvec4 packed(quantizer.interval(node.box.low.x, node.box.high.x, 0),
                      quantizer.interval(node.box.low.y, node.box.high.y, 1),
                      quantizer.interval(node.box.low.z, node.box.high.z, 2), 0u);
    out.push_back(packed);
    if (node.count > 0) {
        packed.w = gpu::kLeafBit | (node.first << 3u) | node.count;
    } else {
        const bool negative = ((octant >> node.axis) & 1u) != 0u;
        emitOctant(tree, quantizer, octant, negative ? node.right : node.left, out);
        emitOctant(tree, quantizer, octant, negative ? node.left : node.right, out);
        packed.w = std::uint32_t(out.size());
    }
    out[place] = packed;
}

glm::uvec4 packCorner(glm::vec3 position, std::uint32_t word)
{
    return glm::uvec4(glm::floatBitsToUint(position), word);
}

} // namespace

Bvh buildBvh(const Scene& scene)
{
    // Leaves address triangles with 28 bits, nodes with 31.
    if (scene.triangles.size() > (1u << 27u))
        throw Error("scene has " + std::to_string(scene.triangles.size()) +
                    " triangles; at most 134217728 are supported");
    Builder builder(makeReferences(scene));
    builder.run();

    Bvh bvh;
    bvh.depth = builder.depth;
    const Box box =
        builder.nodes.empty() ? Box{glm::vec3(0.0f), glm::vec3(0.0f)} : builder.nodes[0].box;
    const Quantizer quantizer = makeQuantizer(box);
    bvh.grid.origin = quantizer.origin;
    bvh.grid.inverseStep = glm::vec3(1.0 / quantizer.step);
    bvh.grid.nodeCount = std::uint32_t(builder.nodes.size());
    bvh.grid.rayOffset = 3.8e-6f * glm::length(box.high - box.low);
    for (std::uint32_t octant = 0; octant < 8 && !builder.nodes.empty(); ++octant)
        emitOctant(builder.nodes, quantizer, octant, 0, bvh.nodes);

    for (const Reference& reference : builder.references()) {
        const std::uint32_t id = reference.triangle;
        const glm::uvec3 t = scene.triangles[id];
        bvh.order.push_back(id);
        bvh.triangles.push_back(packCorner(scene.vertices[t.x].position, id));
        bvh.triangles.push_back(
            packCorner(scene.vertices[t.y].position, scene.triangleMaterials[id]));
        bvh.triangles.push_back(packCorner(scene.vertices[t.z].position, 0u));
    }
    if (bvh.triangles.empty())
        bvh.triangles.resize(3, glm::uvec4(0u));
    if (bvh.nodes.empty())
        bvh.nodes.resize(1, glm::uvec4(0u));
    return bvh;
}

TriangleCorners triangleCorners(const Bvh& bvh, std::uint32_t slot)
{
    const std::size_t base = std::size_t(slot) * 3;
    return {gpu::positionOf(bvh.triangles[base]), gpu::positionOf(bvh.triangles[base + 1]),
            gpu::positionOf(bvh.triangles[base + 2])};
}

} // namespace strandlight
