// Where each triangle corner lies in the atlas, before texels are listed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/atlas.hpp"
#include "engine/scene/atlas_charts.hpp"
#include "engine/scene/atlas_mesh.hpp"

namespace strandlight {

using UvTriangle = std::array<glm::dvec2, 3>;

struct AtlasLayout
{
    std::vector<AtlasCorner> corners; // [triangle * 3]
    std::vector<UvTriangle>
        sampleCorners; // [triangle], texels: as `corners`, but charts under half a texel keep a
                       // width of half a texel, so that samples can lie in their middle
    std::vector<std::uint32_t> chartOf; // [triangle]
    std::uint32_t chartCount = 0;
    float texelsPerMetre = 0.0f;
};

// Packs the charts with the largest uniform scale that fits. Throws Error when one texel per chart
// is too much.
AtlasLayout packCharts(const AtlasMesh& mesh, const std::vector<Chart>& charts,
                       const AtlasSettings& settings);

// The file's second UV set: a chart is a set of triangles connected in UV. Nothing when a value is
// outside [0,1] or a triangle with area has none in UV; `reason` then says why. Overlap is for the
// caller to find.
std::optional<AtlasLayout> layoutTexCoord1(const AtlasMesh& mesh, std::uint32_t resolution,
                                           std::string& reason);

} // namespace strandlight
