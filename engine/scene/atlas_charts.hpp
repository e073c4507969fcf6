// Charts: patches of the surface that unfold onto a plane without folding over themselves.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/atlas_mesh.hpp"

namespace strandlight {

// A surface point p has chart coordinates (dot(p, axisU), dot(p, axisV)) - minimum, in metres,
// within [0, size]. axisU, axisV and the direction of projection are a right-handed frame.
struct Chart
{
    std::vector<std::uint32_t> triangles;
    glm::vec3 axisU = glm::vec3(1.0f, 0.0f, 0.0f);
    glm::vec3 axisV = glm::vec3(0.0f, 1.0f, 0.0f);
    glm::vec2 minimum = glm::vec2(0.0f);
    glm::vec2 size =
        glm::vec2(0.0f); // of the smallest rectangle around the chart; size.x >= size.y
    bool pinned =
        false; // takes one texel whatever the scale: its triangles may lie over each other
};

// Every triangle is in one chart, except for triangles without area that touch no other.
std::vector<Chart> buildCharts(const AtlasMesh& mesh);

glm::vec2 chartCoordinates(const Chart& chart, glm::vec3 position);

} // namespace strandlight
