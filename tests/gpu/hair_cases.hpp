// Strands whose coverage is known, and a camera in which a unit is a pixel.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "passes/hair_render.hpp"

namespace strandlight::test {

// A picture plane at z = 0 in which one unit is one pixel of a side x side picture, y up, origin in
// the middle.
inline Camera pixelCamera(std::uint32_t side)
{
    Camera camera;
    camera.eye = {0.0f, 0.0f, 4.0f * float(side)};
    camera.target = glm::vec3(0.0f);
    camera.verticalFovDegrees = glm::degrees(2.0f * std::atan(0.5f / 4.0f));
    return camera;
}

inline void addStrand(HairStrands& hair, std::initializer_list<glm::vec3> points, float radius)
{
    if (hair.firstPoint.empty())
        hair.firstPoint.push_back(0);
    for (const glm::vec3& point : points) {
        hair.points.push_back(point);
        hair.radii.push_back(radius);
        hair.colors.emplace_back(0.5f);
    }
    hair.firstPoint.push_back(std::uint32_t(hair.points.size()));
}

// Layers that each cover the whole picture: ribbons many pixels wide, one behind the other.
inline HairStrands layers(std::uint32_t count, float side)
{
    HairStrands hair;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float z = -1.0f * float(i);
        addStrand(hair, {{-2.0f * side, 0.0f, z}, {2.0f * side, 0.0f, z}}, 2.0f * side);
    }
    return hair;
}

inline HairRenderSettings plainSettings(std::uint32_t side)
{
    HairRenderSettings settings;
    settings.width = settings.height = side;
    settings.lod = 1;
    settings.shadows = false;
    return settings;
}

inline constexpr std::uint32_t kCells = 4, kCell = 96, kGridSide = kCells * kCell;
inline constexpr float kStrandLength = 64.0f;

// Of parallel strands, in pixels: they never overlap, not even as ribbons a pixel wide with a
// border, and are off the pixels' grid, so that their mean is the expected coverage of one strand.
inline float strandSpacing(float width)
{
    return std::max(1.0f, width) + 1.37f;
}
inline int strandsPerCell(float width)
{
    return int(kStrandLength / strandSpacing(width)) | 1;
}

// 16 cells, one angle each.
inline HairStrands strandGrid(float width)
{
    HairStrands hair;
    for (std::uint32_t cell = 0; cell < kCells * kCells; ++cell) {
        const float angle = float(cell) * 3.14159265f / 16.0f;
        const glm::vec3 along(std::cos(angle), std::sin(angle), 0.0f);
        const glm::vec3 across(-along.y, along.x, 0.0f);
        const glm::vec3 middle(
            (float(cell % kCells) + 0.5f) * float(kCell) - 0.5f * float(kGridSide) + 0.137f,
            (float(cell / kCells) + 0.5f) * float(kCell) - 0.5f * float(kGridSide) + 0.291f, 0.0f);
        const int strands = strandsPerCell(width);
        for (int s = 0; s < strands; ++s) {
            const glm::vec3 place =
                middle + across * (strandSpacing(width) * float(s - strands / 2));
            const glm::vec3 half = along * (0.5f * kStrandLength);
            // Several segments: their joints must neither gap nor overlap.
            addStrand(hair, {place - half, place - 0.3f * half, place + 0.2f * half, place + half},
                      0.5f * width);
        }
    }
    return hair;
}

} // namespace strandlight::test
