// Plane geometry of one chart: the smallest rectangle around it, and which triangles fold over
// others.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/atlas_charts.hpp"

namespace strandlight {

// The chart's axes and size: the rectangle of least area around the triangles seen along
// `direction`.
Chart fitChart(const AtlasMesh& mesh, std::vector<std::uint32_t> triangles, glm::vec3 direction);

// Removes from `triangles`, and returns, those that cover ground which an earlier one covers
// already when seen along `direction`; found on a raster of up to 512 cells per side. The first
// triangle always stays.
std::vector<std::uint32_t> removeFolds(const AtlasMesh& mesh, std::vector<std::uint32_t>& triangles,
                                       glm::vec3 direction);

} // namespace strandlight
