// The last touch of a fit: every texel's lobes give the irradiance that was captured.
#pragma once

#include <cstdint>

#include "passes/sg_field.hpp"
#include "passes/sg_fit_cells.hpp"

namespace strandlight {

// Scales each texel's amplitudes, channel by channel, so that the cosine-weighted integral of its
// lobes over the hemisphere is that of its image. A fit of radiance alone is 1 to 3 % off,
// differently in each texel, which shows as blotches on plain walls. Texels without image and black
// channels stay; factors are held to [0.5, 2]. Returns how many channels were held.
std::uint64_t matchIrradiance(const FitProblem& problem, SgField& field);

} // namespace strandlight
