#include "passes/sg_fit_irradiance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/assert.hpp"
#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg_diffuse.h"
#include "shaders/shared/sg_fit_types.h"

namespace strandlight {

namespace {

constexpr double kLargestFactor = 2.0; // a texel that needs more has another trouble

// Irradiance of the captured images. [texel]; texels without an image get 0.
std::vector<glm::dvec3> capturedIrradiance(const FitProblem& problem)
{
    const std::uint32_t texels = problem.texelCount();
    std::vector<glm::dvec3> out(texels, glm::dvec3(0.0));
    double cosineSum = 0.0;
    for (const glm::vec4& direction : problem.directions)
        cosineSum += double(direction.z) * double(direction.w);
    for (std::uint32_t d = 0; d < problem.directionCount(); ++d) {
        // The cells' cosines add up to pi exactly, whatever the midpoint rule says.
        const double weight = double(problem.directions[d].z) * double(problem.directions[d].w) *
                              double(gpu::kPi) / cosineSum;
        for (std::uint32_t t = 0; t < texels; ++t)
            if (problem.scales[t] >= 0.0f)
                out[t] +=
                    weight *
                    glm::dvec3(gpu::unpackRgb9e5(problem.images[std::size_t(d) * texels + t]));
    }
    return out;
}

std::vector<glm::dvec3> lobeIrradiance(const FitProblem& problem, const SgField& field)
{
    std::vector<glm::dvec3> out(problem.texelCount(), glm::dvec3(0.0));
    for (std::uint32_t t = 0; t < problem.texelCount(); ++t)
        for (std::uint32_t k = 0; problem.scales[t] >= 0.0f && k < field.lobeCount; ++k) {
            const SgLobe& lobe = field.lobes[std::size_t(t) * field.lobeCount + k];
            out[t] += glm::dvec3(lobe.amplitude) *
                      double(gpu::sgIrradiance(std::exp(lobe.logSharpness), lobe.axis.z));
        }
    return out;
}

void averageOverNeighbours(const FitCells& cells, std::vector<glm::dvec3>& values)
{
    std::vector<glm::dvec3> next = values;
    for (std::uint32_t t = 0; t < cells.texelCount; ++t)
        for (std::uint32_t side = 0; side < 4; ++side) {
            const std::uint32_t other = cells.neighbours[std::size_t(side) * cells.texelCount + t];
            if (other != gpu::kSgFitNone)
                next[t] += values[other];
        }
    values = std::move(next); // sums, not means: only the ratio of two such arrays is used
}

// Scales amplitudes by wanted / given. Returns how many factors were held.
std::uint64_t scaleAmplitudes(SgField& field, const std::vector<glm::dvec3>& wanted,
                              const std::vector<glm::dvec3>& given)
{
    std::uint64_t held = 0;
    for (std::size_t texel = 0; texel < given.size(); ++texel)
        for (int channel = 0; channel < 3; ++channel) {
            if (!(given[texel][channel] > 0.0))
                continue;
            const double factor = wanted[texel][channel] / given[texel][channel];
            const double kept = std::clamp(factor, 1.0 / kLargestFactor, kLargestFactor);
            held += kept != factor ? 1 : 0;
            for (std::uint32_t k = 0; k < field.lobeCount; ++k)
                field.lobes[texel * field.lobeCount + k].amplitude[channel] *= float(kept);
        }
    return held;
}

} // namespace

std::uint64_t matchIrradiance(const FitProblem& problem, SgField& field, std::uint32_t rounds)
{
    STRANDLIGHT_ASSERT_EQ(field.lobes.size(), std::size_t(problem.texelCount()) * field.lobeCount);
    std::vector<glm::dvec3> wanted = capturedIrradiance(problem);
    std::vector<glm::dvec3> given = lobeIrradiance(problem, field);
    for (std::uint32_t round = 0; round < rounds; ++round) {
        averageOverNeighbours(problem.cells, wanted);
        averageOverNeighbours(problem.cells, given);
    }
    return scaleAmplitudes(field, wanted, given);
}

void matchIrradianceOf(const FitProblem& problem, const SgField& whole, SgField& field)
{
    scaleAmplitudes(field, lobeIrradiance(problem, whole), lobeIrradiance(problem, field));
}

} // namespace strandlight
