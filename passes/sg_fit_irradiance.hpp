// The last touch of a fit: lobes send as much light onto their surface as the images did.
// Least squares under the fit's weights (bright directions count less, so that one lamp does not
// rule a texel) loses a few per cent of the energy; a diffuse surface shows exactly that.
#pragma once

#include <cstdint>

#include "passes/sg_field.hpp"
#include "passes/sg_fit_cells.hpp"

namespace strandlight {

// Scales the amplitudes of every texel, per channel, so that sgIrradiance() of its lobes (what
// shading evaluates) equals the cosine-weighted sum over its image, both summed over neighbours of
// the chart for `rounds` rounds: the noise of one texel's capture must not become a blotch. Texels
// without image follow their neighbours, black channels stay; factors are held to [0.5, 2]. Returns
// how many were held. Deterministic, on the CPU.
std::uint64_t matchIrradiance(const FitProblem& problem, SgField& field, std::uint32_t rounds = 2);

// The same for lobes of which some were dropped: each texel sends what those of `whole` send. A
// texel for itself: `whole` is smooth already.
void matchIrradianceOf(const FitProblem& problem, const SgField& whole, SgField& field);

} // namespace strandlight
