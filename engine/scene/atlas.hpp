// The unique UV atlas: every surface point of the scene has one place in [0,1]^2, and no two share
// a texel.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/scene.hpp"

namespace strandlight {

struct AtlasSettings
{
    std::uint32_t resolution = 128; // texels per side
    std::uint32_t gutter = 2;       // empty texels between charts
};

// One triangle corner in the atlas. `tangent` is the direction of growing atlas u on the surface,
// smooth within a chart. The frame at a surface point: N = normalised interpolated vertex normal, T
// = tangent made orthogonal to N, B = cross(N, T). Light-field images and lobes live in (T, B, N).
struct AtlasCorner
{
    glm::vec2 uv =
        glm::vec2(0.0f); // texels, not [0,1]: texel (x, y) has its centre at (x + 0.5, y + 0.5)
    glm::vec3 tangent = glm::vec3(1.0f, 0.0f, 0.0f);
};

// A texel that shading can touch: its centre, or the point of its chart nearest to the centre.
struct AtlasTexel
{
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t triangle = 0;              // index into Scene::triangles
    glm::vec2 barycentric = glm::vec2(0.0f); // weights of corners 1 and 2
    std::uint32_t chart = 0;
};

struct Atlas
{
    std::uint32_t resolution = 0;
    std::uint32_t chartCount = 0;
    // Charts without a texel of their own: they share one with others near them that face the same
    // way. Known to buildAtlas() alone, not kept in files.
    std::uint32_t sharingCharts = 0;
    bool usedTexCoord1 = false;
    float texelsPerMetre = 0.0f;
    std::vector<AtlasCorner> corners; // [triangles * 3]
    std::vector<AtlasTexel> texels;   // covered texels, ordered by y, then x
};

// The surface point of a texel, with its frame.
struct AtlasPoint
{
    glm::vec3 position = glm::vec3(0.0f);
    glm::vec3 geometricNormal = glm::vec3(0.0f, 0.0f, 1.0f); // of the triangle, on the side of N
    glm::vec3 t = glm::vec3(1.0f, 0.0f, 0.0f);
    glm::vec3 b = glm::vec3(0.0f, 1.0f, 0.0f);
    glm::vec3 n = glm::vec3(0.0f, 0.0f, 1.0f);
};

// TEXCOORD_1 where it is a valid set (inside [0,1], no overlap at this resolution), else charts of
// our own by normal and adjacency, packed with the largest uniform scale that fits. Throws Error
// when not even one texel per chart fits.
//
// Our charts span whole texels, from centre to centre, so a bilinear lookup on a chart gives weight
// to texels of that chart only, and every such texel is in the list. A chart under half a texel
// wide has all its points at that texel's centre; those that are under half a texel in both
// directions are stored side by side without gutter. A texel whose centre is off the chart (or on
// its border) is sampled at the nearest chart point, moved a tenth of a texel inwards, so that no
// sample lies in the corner of two walls.
Atlas buildAtlas(const Scene& scene, const AtlasSettings& settings);

AtlasPoint evaluateAtlasTexel(const Scene& scene, const Atlas& atlas, const AtlasTexel& texel);

// Where each texel's entry in `Atlas::texels` is; kNoTexel where no surface is. [resolution,
// resolution], row-major
inline constexpr std::uint32_t kNoTexel = ~0u;
std::vector<std::uint32_t> atlasTexelMap(const Atlas& atlas);

} // namespace strandlight
