// Which texels a layout touches, and where on the surface each is sampled.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/scene/atlas_layout.hpp"

namespace strandlight {

struct TexelList
{
    std::vector<AtlasTexel> texels; // ordered by y, then x
    std::string overlap; // empty, or the first place where two charts or two triangles of one meet
};

// All texels that get a positive weight in a bilinear lookup somewhere on a triangle.
TexelList listTexels(const AtlasMesh& mesh, const AtlasLayout& layout, std::uint32_t resolution);

// True when a bilinear lookup somewhere on the triangle (in texels, possibly flat) weighs texel (x,
// y) by more than a thousandth.
bool touchesTexel(const UvTriangle& triangle, int x, int y);

struct NearestPoint
{
    glm::dvec2 barycentric{0.0}; // weights of corners 1 and 2
    double distance = 0.0;       // 0: inside
};
NearestPoint nearestPoint(const UvTriangle& triangle, glm::dvec2 point);

} // namespace strandlight
