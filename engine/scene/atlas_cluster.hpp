// For scenes of thousands of small separate parts: charts too small to matter share texels.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/atlas_charts.hpp"

namespace strandlight {

// Unites small charts that lie near each other and face the same of six directions until at most
// `limit` charts remain or nothing is left to unite: in the smallest cells in which that can be
// reached, and there the smallest charts first, so that large ones keep their texels. A united
// chart is `pinned`: it takes one texel.
std::vector<Chart> clusterSmallCharts(const AtlasMesh& mesh, std::vector<Chart> charts,
                                      std::size_t limit);

} // namespace strandlight
