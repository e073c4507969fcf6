// Error-driven lobe count: lobes that the fit hardly needs are dropped, tile by tile of the atlas.
// Backward elimination of least squares: with axes and sharpness held, removing lobe k and giving
// its light to the others as well as they can take it raises a texel's squared error by a_k^2 /
// (G^-1)_kk, where G holds the inner products of the lobes.
// Miller. Subset Selection in Regression. 2002
#pragma once

#include "passes/sg_field.hpp"
#include "passes/sg_fit_cells.hpp"
#include "passes/sg_fit_settings.hpp"

namespace strandlight {

// Drops the cheapest lobes of all tiles (problem.tiles) until the root of the summed squared error
// would grow by more than the fraction `lobeError`. The error is the fit's: relative to each
// texel's mean radiance, bright directions softened. Cheapest is what a picture misses least: dark
// and rough texels (problem.gloss) give up lobes first. Amplitudes of the kept lobes take over what
// they can. Lobes without light go at any `lobeError`: a tile that receives none keeps none. On the
// CPU, deterministic.
void pruneLobes(const FitProblem& problem, const FitSettings& settings, SgField& field);

// Sets lobesDropped, tiles and darkTiles.
void countDropped(const FitProblem& problem, const SgField& field, FitStatistics& statistics);

} // namespace strandlight
