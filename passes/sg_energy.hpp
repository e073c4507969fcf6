// The last step of a fit: lobes that send as much light onto their surface as the images did.
// Least squares under the fit's weights (bright directions count less, so that one lamp does not
// rule a texel) loses a few per cent of the energy; a diffuse surface shows exactly that.
#pragma once

#include <cstdint>

#include "passes/sg_field.hpp"
#include "passes/sg_fit_cells.hpp"

namespace strandlight {

struct EnergySettings
{
    // Rounds of averaging over the four neighbours of a chart, for both sides of the ratio alike:
    // the noise of one texel's capture must not become a blotch.
    std::uint32_t rounds = 2;
    float largestFactor = 2.0f; // and 1 / this: a texel that needs more has another trouble
};

struct EnergyStatistics
{
    double meanRatioBefore =
        1.0; // irradiance of the lobes over that of the images, all texels together
    std::uint64_t clampedFactors = 0;
};

// Scales the amplitudes of every texel, per channel, so that sgIrradiance() of its lobes (what
// shading evaluates) equals the cosine-weighted sum over its image, both averaged over neighbours.
// Deterministic, on the CPU.
EnergyStatistics matchIrradiance(const FitProblem& problem, SgField& field,
                                 const EnergySettings& settings = {});

} // namespace strandlight
