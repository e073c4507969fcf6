// An analytic light field for tests of fitting: a box room with a window, a lamp and a pillar, seen
// from a grid of points on its floor. The truth between the points is known without any capture.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "engine/scene/atlas.hpp"
#include "passes/fit_report.hpp"
#include "passes/lightfield.hpp"

namespace strandlight::test {

struct SyntheticRoom
{
    std::uint32_t grid = 12; // points per side
    float extent = 1.7f;     // of the grid, in a room 2 wide
    std::uint32_t size = 16; // of the hemi-octahedral images
    float lights = 1.0f;     // factor on window and lamp
};

// One chart of grid x grid texels.
Atlas gridAtlas(std::uint32_t grid);
// Mean of 4 x 4 rays per image cell.
CpuLightfield roomLightfield(const SyntheticRoom& room);
// The same room seen from the centres of the cells that `probes` names.
void captureRoomProbes(const SyntheticRoom& room, const Atlas& atlas, FitProbes& probes);

// grid x grid images of the same radiance(direction).
template <class Radiance>
CpuLightfield uniformLightfield(std::uint32_t grid, std::uint32_t size, const Radiance& radiance);

} // namespace strandlight::test

#include "passes/sg_fit_cells.hpp"
#include "shaders/shared/rgb9e5.h"

template <class Radiance>
strandlight::CpuLightfield strandlight::test::uniformLightfield(std::uint32_t grid,
                                                                std::uint32_t size,
                                                                const Radiance& radiance)
{
    CpuLightfield field;
    field.size = size;
    field.texelCount = grid * grid;
    field.valid.assign(field.texelCount, 1);
    const std::vector<glm::vec4> directions = fitDirections(size);
    for (std::uint32_t t = 0; t < field.texelCount; ++t)
        for (const glm::vec4& d : directions)
            field.radiance.push_back(gpu::packRgb9e5(radiance(glm::vec3(d))));
    return field;
}
