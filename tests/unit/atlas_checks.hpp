// Scenes for the atlas tests, and what every atlas has to keep.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/scene/atlas.hpp"

namespace strandlight::test {

// Corners of their own and the face's normal; material 0.
void addTriangle(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 c);
void addQuad(Scene& scene, glm::vec3 corner, glm::vec3 u, glm::vec3 v);
Scene makeCube();
Scene makeSphere(int rings, int sectors);
Scene makeSoup(std::uint32_t count, std::uint32_t seed);

glm::vec2 uvAt(const Atlas& atlas, std::uint32_t triangle, glm::vec2 weights);
std::vector<std::uint32_t> chartsOfTriangles(const Scene& scene, const Atlas& atlas);

// Every texel that weighs in a lookup at random points of every triangle is listed, and belongs to
// one chart only.
void checkLookups(const Scene& scene, const Atlas& atlas, std::uint32_t pointsPerTriangle);
// Texels are in order, within their triangle, and sampled at most a texel's diagonal (and the
// inset) from the centre.
void checkTexels(const Scene& scene, const Atlas& atlas);
// Both, of a new atlas.
void checkAll(const Scene& scene, std::uint32_t resolution, std::uint32_t pointsPerTriangle = 40);

// Of triangle t: signed in texture coordinates, in square metres.
double uvAreaOf(const Atlas& atlas, std::uint32_t t);
double areaOf(const Scene& scene, std::uint32_t t);

// What buildAtlas refuses the scene with; empty where it does not.
std::string errorOf(const Scene& scene, std::uint32_t resolution);

} // namespace strandlight::test
