// How well lobes and their rivals keep the captured light, at texels and between them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "passes/light_field_baselines.hpp"
#include "passes/lightfield.hpp"
#include "passes/sg_fit_cells.hpp"

namespace strandlight {

// Points between texels where the light is known: the truth that no fit has seen.
struct FitProbes
{
    std::vector<glm::uvec4> texels;    // [probe] the four texels around
    std::vector<glm::vec4> weights;    // [probe] bilinear weights
    std::vector<std::uint32_t> images; // [probe, direction] RGB9E5, in the interpolated frame
};

// Centres of at most `count` cells whose four texels have images, evenly picked. Images are left
// empty.
FitProbes cellCentreProbes(const FitProblem& problem, std::uint32_t count);

struct FitReportRow
{
    std::string name;
    double texelRmse = 0.0;        // radiance, over solid angle, texels and channels
    double interpolatedRmse = 0.0; // the same at the probes; NaN without probe images
    double texelIrradiance = 0.0;  // mean |error| of the irradiance over its mean
    double interpolatedIrradiance = 0.0;
    double bytesPerTexel = 0.0;
    double seconds = 0.0;
};

struct FitReport
{
    double signalRms = 0.0;
    std::uint32_t texels = 0; // that were looked at
    std::uint32_t probes = 0;
    std::vector<FitReportRow> rows;

    std::string text() const; // a table, one line a row
};

// Looks at no more than `maximumTexels` evenly picked texels with images, and at all probes.
FitReport compareFits(const FitProblem& problem, const FitProbes& probes,
                      const std::vector<LightFieldModel>& models,
                      std::uint32_t maximumTexels = 4096);

} // namespace strandlight
