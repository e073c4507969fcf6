// Coarse to fine: what blocks of 2 x 2 texels saw together is fitted first, and their lobes are
// where the texels start. Lobes so find their places together over whole charts, in a fraction of
// the time that single texels, each with its own noise, take to agree.
#pragma once

#include <cstdint>
#include <vector>

#include "passes/sg_fit_cells.hpp"

namespace strandlight {

// A problem whose texels are blocks of a finer one. Blocks do not reach across charts.
struct CoarseProblem
{
    FitProblem problem; // images are means of those of the block's texels that have one
    std::uint32_t side = 2;
};

CoarseProblem coarsen(const FitProblem& fine);

// Lobes [texel of the fine problem, lobe]: parameters of the blocks, bilinear inside a chart; the
// amplitudes follow each texel's own mean radiance.
SgField interpolateBlocks(const FitProblem& fine, const CoarseProblem& coarse,
                          const SgField& blocks);

// Makes each texel's lobes together as bright as fits its own image best: what blocks saw may be
// black in one of their texels, and a bright narrow lobe would take thousands of steps to fade.
void matchBrightness(const FitProblem& problem, const FitSettings& settings, SgField& field);

} // namespace strandlight
