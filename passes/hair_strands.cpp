#include "passes/hair_strands.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace strandlight {
namespace {

constexpr float kLodWidth = 0.15f; // pixels
constexpr std::uint32_t kLodMost = 16;
constexpr std::uint32_t kLodFewestStrands = 4096;
constexpr std::uint32_t kMostSparseStrands = 4096;

std::uint32_t packAlbedo(const Scene& scene, std::size_t triangle)
{
    const std::uint32_t material = scene.triangleMaterials.at(triangle);
    const glm::vec4 color =
        scene.materials.empty() ? glm::vec4(0.5f) : scene.materials.at(material).baseColor;
    std::uint32_t word = 0;
    for (int c = 0; c < 3; ++c)
        word |= std::uint32_t(std::lround(std::clamp(color[c], 0.0f, 1.0f) * 255.0f)) << (8 * c);
    return word;
}

std::vector<glm::vec4> surfaceCorners(const Scene& scene)
{
    std::vector<glm::vec4> corners;
    corners.reserve(scene.triangles.size() * 6);
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const float albedo = glm::uintBitsToFloat(packAlbedo(scene, t));
        for (int k = 0; k < 3; ++k) {
            const Vertex& vertex = scene.vertices.at(scene.triangles[t][k]);
            corners.emplace_back(vertex.position, albedo);
            corners.emplace_back(vertex.normal, 0.0f);
        }
    }
    return corners;
}

// Every step-th strand with all of its points.
HairStrands everyStrand(const HairStrands& hair, std::uint32_t step)
{
    HairStrands some;
    some.firstPoint.push_back(0);
    for (std::uint32_t strand = 0; strand < hair.strandCount(); strand += step) {
        const std::uint32_t first = hair.firstPoint[strand];
        const std::uint32_t last = hair.firstPoint[strand + 1];
        some.points.insert(some.points.end(), &hair.points[first], &hair.points[last - 1] + 1);
        some.radii.insert(some.radii.end(), &hair.radii[first], &hair.radii[last - 1] + 1);
        some.colors.insert(some.colors.end(), &hair.colors[first], &hair.colors[last - 1] + 1);
        some.firstPoint.push_back(std::uint32_t(some.points.size()));
    }
    return some;
}

// Of every step-th strand: first point, strand.
std::vector<glm::uvec2> segmentsOf(const HairStrands& hair, std::uint32_t step)
{
    std::vector<glm::uvec2> segments;
    for (std::uint32_t strand = 0; strand < hair.strandCount(); strand += step)
        for (std::uint32_t p = hair.firstPoint[strand]; p + 1 < hair.firstPoint[strand + 1]; ++p)
            segments.emplace_back(p, strand);
    return segments;
}

Buffer uploadPoints(Context& context, const std::vector<glm::vec3>& xyz,
                    const std::vector<float>* w, const std::string& name)
{
    std::vector<glm::vec4> values(xyz.size());
    for (std::size_t i = 0; i < xyz.size(); ++i)
        values[i] = glm::vec4(xyz[i], w ? (*w)[i] : 0.0f);
    return Buffer::from(context, values, name);
}

void uploadSegments(Context& context, HairBuffers& buffers, const HairStrands& drawn,
                    std::uint32_t allStrands)
{
    const std::vector<glm::uvec2> segments = segmentsOf(drawn, 1);
    buffers.segments = Buffer::from(context, segments, "hair segments");
    buffers.segmentCount = std::uint32_t(segments.size());
    buffers.strandCount = drawn.strandCount();
    buffers.widthScale = float(allStrands) / float(buffers.strandCount);

    const std::uint32_t step = (drawn.strandCount() + kMostSparseStrands - 1) / kMostSparseStrands;
    const std::vector<glm::uvec2> sparse = segmentsOf(drawn, step);
    buffers.sparse = Buffer::from(context, sparse, "hair sparse segments");
    buffers.sparseSegments = std::uint32_t(sparse.size());
    buffers.sparseScale = float(allStrands) / float((drawn.strandCount() + step - 1) / step);
}

} // namespace

std::vector<glm::vec3> hairTangents(const HairStrands& hair)
{
    std::vector<glm::vec3> tangents(hair.points.size());
    for (std::uint32_t strand = 0; strand < hair.strandCount(); ++strand) {
        const std::uint32_t first = hair.firstPoint[strand];
        const std::uint32_t last = hair.firstPoint[strand + 1] - 1;
        for (std::uint32_t p = first; p <= last; ++p) {
            const glm::vec3 before = hair.points[p > first ? p - 1 : p];
            const glm::vec3 along = hair.points[p < last ? p + 1 : p] - before;
            const float size = glm::length(along);
            // Points that coincide take the tangent before them.
            const glm::vec3 fallback = p > first ? tangents[p - 1] : glm::vec3(0.0f, 1.0f, 0.0f);
            tangents[p] = size > 0.0f ? along / size : fallback;
        }
    }
    return tangents;
}

HairBuffers uploadHair(Context& context, const HairStrands& hair, const Scene* opaque,
                       std::span<const gpu::HairLight> lights, std::uint32_t lod)
{
    HairBuffers buffers;
    const HairStrands some = lod > 1 ? everyStrand(hair, lod) : HairStrands{};
    const HairStrands& drawn = lod > 1 ? some : hair;
    buffers.pointCount = std::uint32_t(drawn.points.size());
    buffers.points = uploadPoints(context, drawn.points, &drawn.radii, "hair points");
    buffers.tangents = uploadPoints(context, hairTangents(drawn), nullptr, "hair tangents");
    buffers.colors = uploadPoints(context, drawn.colors, nullptr, "hair colors");
    buffers.shaded = Buffer(context, drawn.points.size() * sizeof(glm::vec4), "hair shaded");
    uploadSegments(context, buffers, drawn, hair.strandCount());
    if (opaque && !opaque->triangles.empty()) {
        buffers.surface = Buffer::from(context, surfaceCorners(*opaque), "hair occluders");
        const std::vector<glm::vec4> all(opaque->triangles.size() * 3, glm::vec4(1.0f));
        buffers.visibility = Buffer::from(context, all, "hair occluder visibility");
        buffers.triangleCount = std::uint32_t(opaque->triangles.size());
    }
    buffers.lights = Buffer::from(context, lights, "hair lights");
    buffers.lobes = Buffer::from(context, std::span<const gpu::HairLobe>(), "hair lobes");
    return buffers;
}

DepthRange hairDepthRange(const HairStrands& hair, const Scene* opaque, const Camera& camera)
{
    glm::vec3 low = hair.boundsMin();
    glm::vec3 high = hair.boundsMax();
    if (opaque && !opaque->vertices.empty()) {
        low = glm::min(low, opaque->boundsMin());
        high = glm::max(high, opaque->boundsMax());
    }
    const glm::vec3 farthest = glm::max(glm::abs(low - camera.eye), glm::abs(high - camera.eye));
    DepthRange range;
    range.farPlane = std::max(1.01f * glm::length(farthest), 1e-3f);
    range.nearPlane = 1e-3f * range.farPlane;
    return range;
}

HairDepthScale hairDepthScale(const HairStrands& hair, const Camera& camera)
{
    const HairSphere sphere = boundingSphere(hair);
    return {glm::length(camera.eye - sphere.centre) - sphere.radius, 0.5f / sphere.radius};
}

std::uint32_t automaticHairLod(const HairStrands& hair, const Camera& camera, std::uint32_t height)
{
    double sum = 0.0;
    for (const float radius : hair.radii)
        sum += double(radius);
    const float mean = hair.radii.empty() ? 0.0f : float(sum / double(hair.radii.size()));
    const HairSphere sphere = boundingSphere(hair);
    const float distance = std::max(glm::length(camera.eye - sphere.centre), 1e-6f);
    const float pixelsPerUnit =
        0.5f * float(height) / std::tan(glm::radians(0.5f * camera.verticalFovDegrees));
    const float width = 2.0f * mean * pixelsPerUnit / distance;
    const std::uint32_t byCount = std::clamp(hair.strandCount() / kLodFewestStrands, 1u, kLodMost);
    if (!(width > 0.0f))
        return byCount;
    return std::clamp(std::uint32_t(std::min(kLodWidth / width, float(kLodMost))), 1u, byCount);
}

} // namespace strandlight
