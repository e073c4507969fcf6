#include "engine/scene/atlas.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "engine/base/log.hpp"
#include "engine/scene/atlas_charts.hpp"
#include "engine/scene/atlas_cluster.hpp"
#include "engine/scene/atlas_layout.hpp"
#include "engine/scene/atlas_texels.hpp"

namespace strandlight {

namespace {

constexpr std::uint32_t kMaximumResolution = 4096;

// Small charts cost many texels of gutter. More charts than this leave no room for the large ones:
// then the smallest share.
constexpr std::size_t kTexelsPerChart = 32;

Atlas assembleAtlas(AtlasLayout layout, TexelList list, std::uint32_t resolution)
{
    Atlas atlas;
    atlas.resolution = resolution;
    atlas.chartCount = layout.chartCount;
    atlas.texelsPerMetre = layout.texelsPerMetre;
    atlas.corners = std::move(layout.corners);
    atlas.texels = std::move(list.texels);
    return atlas;
}

glm::vec3 interpolate(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, glm::vec2 weights)
{
    return a * (1.0f - weights.x - weights.y) + b * weights.x + c * weights.y;
}

glm::vec3 normaliseOr(glm::vec3 v, glm::vec3 fallback)
{
    const float length = glm::length(v);
    return length > 1e-12f ? v / length : fallback;
}

} // namespace

Atlas buildAtlas(const Scene& scene, const AtlasSettings& settings)
{
    if (settings.resolution < 1 || settings.resolution > kMaximumResolution)
        throw Error("atlas: a resolution of " + std::to_string(settings.resolution) +
                    " is not within 1 and " + std::to_string(kMaximumResolution));
    if (scene.triangles.empty())
        throw Error("atlas: the scene has no triangles");
    const AtlasMesh mesh(scene);

    if (scene.hasTexCoord1) {
        std::string reason;
        if (auto layout = layoutTexCoord1(mesh, settings.resolution, reason)) {
            TexelList list = listTexels(mesh, *layout, settings.resolution);
            reason = list.overlap;
            if (reason.empty()) {
                Atlas atlas =
                    assembleAtlas(std::move(*layout), std::move(list), settings.resolution);
                atlas.usedTexCoord1 = true;
                return atlas;
            }
        }
        logInfo("atlas: TEXCOORD_1 is not usable at " + std::to_string(settings.resolution) +
                " texels: " + reason + "; making charts");
    }

    const std::size_t texelCount = std::size_t(settings.resolution) * settings.resolution;
    const std::vector<Chart> built = buildCharts(mesh);
    const std::vector<Chart> charts =
        clusterSmallCharts(mesh, built, std::max<std::size_t>(1, texelCount / kTexelsPerChart));
    AtlasLayout layout = packCharts(mesh, charts, settings);
    TexelList list = listTexels(mesh, layout, settings.resolution);
    Atlas atlas = assembleAtlas(std::move(layout), std::move(list), settings.resolution);
    atlas.sharingCharts = static_cast<std::uint32_t>(built.size() - charts.size());
    return atlas;
}

AtlasPoint evaluateAtlasTexel(const Scene& scene, const Atlas& atlas, const AtlasTexel& texel)
{
    STRANDLIGHT_ASSERT(texel.triangle < scene.triangles.size());
    STRANDLIGHT_ASSERT_EQ(atlas.corners.size(), scene.triangles.size() * 3);
    const glm::uvec3 indices = scene.triangles[texel.triangle];
    const Vertex& a = scene.vertices[indices.x];
    const Vertex& b = scene.vertices[indices.y];
    const Vertex& c = scene.vertices[indices.z];
    const AtlasCorner* corners = &atlas.corners[std::size_t(texel.triangle) * 3];

    AtlasPoint point;
    point.position = interpolate(a.position, b.position, c.position, texel.barycentric);
    const glm::vec3 face =
        normaliseOr(glm::cross(b.position - a.position, c.position - a.position), a.normal);
    point.n = normaliseOr(interpolate(a.normal, b.normal, c.normal, texel.barycentric), face);
    point.geometricNormal = glm::dot(face, point.n) < 0.0f ? -face : face;

    // A tangent along N carries no direction; any one across N serves then.
    const glm::vec3 along =
        interpolate(corners[0].tangent, corners[1].tangent, corners[2].tangent, texel.barycentric);
    const glm::vec3 helper =
        std::abs(point.n.y) < 0.9f ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(1.0f, 0.0f, 0.0f);
    const glm::vec3 fallback = glm::normalize(glm::cross(helper, point.n));
    point.t = normaliseOr(along - point.n * glm::dot(point.n, along), fallback);
    point.b = glm::cross(point.n, point.t);
    return point;
}

std::vector<std::uint32_t> atlasTexelMap(const Atlas& atlas)
{
    std::vector<std::uint32_t> map(std::size_t(atlas.resolution) * atlas.resolution, kNoTexel);
    for (std::size_t i = 0; i < atlas.texels.size(); ++i) {
        const AtlasTexel& texel = atlas.texels[i];
        map[std::size_t(texel.y) * atlas.resolution + texel.x] = static_cast<std::uint32_t>(i);
    }
    return map;
}

} // namespace strandlight
