// CPU twin of the direct SG fit's kernels, in double and in plain loops: one step's loss, gradient
// and update. Judge of the kernels (tests/render/test_sg_fit.cpp) and itself judged by finite
// differences (tests/unit).
#pragma once

#include <cstdint>
#include <vector>

#include "passes/sg_fit_cells.hpp"
#include "passes/sg_fit_settings.hpp"
#include "shaders/shared/sg_fit_types.h"

namespace strandlight {

struct FitStateReference
{
    std::uint32_t step = 0;
    std::vector<double> parameters;    // [lobe * 2 + half, texel, 4]
    std::vector<double> firstMoments;  // the same
    std::vector<double> secondMoments; // [lobe, texel, 4]
};

// Parameters addressed by lobe, component and texel.
struct LobeBlock
{
    const std::vector<double>& values;
    std::uint32_t texelCount;

    double at(std::uint32_t lobe, std::uint32_t component, std::uint32_t texel) const
    {
        return values[gpu::sgFitIndex(lobe, component, texel, texelCount)];
    }
    glm::dvec3 at3(std::uint32_t lobe, std::uint32_t component, std::uint32_t texel) const
    {
        return {at(lobe, component, texel), at(lobe, component + 1, texel),
                at(lobe, component + 2, texel)};
    }
};

FitStateReference toReference(const FitState& state);
FitState fromReference(const FitStateReference& state);

// What shaders/sg_fit/sg_fit_cells.comp writes.
struct FitCellGradients
{
    std::vector<double>
        gradients;              // [lobe * 2 + half, cell, 4], with respect to the interpolated lobe
    std::vector<double> losses; // [cell]
    double loss() const;        // sum over cells
};

FitCellGradients sgFitCellsReference(const FitProblem& problem, const FitStateReference& state,
                                     const FitSettings& settings);

// dL/d(parameters) of the summed loss of the cells, through the bilinear weights. [lobe * 2 + half,
// texel, 4]
std::vector<double> sgFitGatherReference(const FitProblem& problem, const FitCellGradients& cells,
                                         std::uint32_t step, const FitSettings& settings);

// Gather, smoothness and one Adam step; what shaders/sg_fit/sg_fit_update.comp does. Raises
// state.step.
void sgFitUpdateReference(const FitProblem& problem, const FitCellGradients& cells,
                          const FitSettings& settings, FitStateReference& state);

// settings.steps steps from a start. Slow; for tests and small fields.
SgField fitLobesReference(const FitProblem& problem, const FitState& start,
                          const FitSettings& settings);

} // namespace strandlight
