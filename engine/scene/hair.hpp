// Hair on the CPU: strands as polylines, root first. Units are metres, right-handed, +y up.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/scene.hpp"

namespace strandlight {

// Strand s has the points firstPoint[s] .. firstPoint[s + 1] - 1, at least two of them.
struct HairStrands
{
    std::string name;
    std::vector<glm::vec3> points;         // [points] all strands after each other, metres
    std::vector<std::uint32_t> firstPoint; // [strands + 1]; empty when there is no strand
    std::vector<float> radii;              // [points] true radius in metres, tapered at the tip
    std::vector<glm::vec3> colors;         // [points] linear albedo in [0, 1], varied per strand

    std::uint32_t strandCount() const;
    std::uint32_t segmentCount() const; // points less strands
    glm::vec3 boundsMin() const;        // of the points; 0 without any
    glm::vec3 boundsMax() const;
};

// Throws Error, with the values in the text, when the arrays do not belong together, a strand has
// fewer than two points, or a value is not finite, a radius negative, a colour outside [0, 1].
void checkHair(const HairStrands& hair);

// `count` strands spread evenly over the order of the file; all of them when there are fewer.
HairStrands selectStrands(const HairStrands& hair, std::uint32_t count);

// Factor on the radius at t in [0, 1] from root to tip: 1, then falling to a tenth over the last
// quarter.
float tipTaper(float t);

// Fills `colors`: `color`, brighter or darker and warmer or cooler by up to `variation` per strand,
// darker at the root and brighter at the tip by half of it; clamped to [0, 1].
void paintHair(HairStrands& hair, glm::vec3 color, float variation, std::uint32_t seed);

// Frames the bounds from in front (+z) and a little from the side and above.
Camera hairCamera(const HairStrands& hair);

} // namespace strandlight
