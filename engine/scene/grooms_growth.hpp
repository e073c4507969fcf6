// How strands of a groom grow: step by step from the root, each step straight and of equal length.
#pragma once

#include <span>

#include "engine/scene/grooms.hpp"

namespace strandlight {

// What makes a style, beside its settings.
struct GroomShape
{
    float lift = 1.0f;      // of the first direction: along the normal against along the comb
    float gravity = 20.0f;  // turns the direction downwards, per metre
    float curlTilt = 0.0f;  // radians between a step and the axis of the curl
    float curlPitch = 0.1f; // metres of strand per turn; never fewer than four steps
    bool isFlat = false;    // waves in a plane instead of helices
    bool isTied = false;    // at the back of the head, then falling
};

// points [strands][segments + 1], root first. Settings must be in their ranges.
void growStrands(const GroomShape& shape, const GroomSettings& settings,
                 std::span<glm::vec3> points);

} // namespace strandlight
