#include "passes/sg_fit_reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <glm/gtc/type_precision.hpp>

#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg_fit_types.h"

namespace strandlight {
namespace {

using glm::dvec3;

// The 4 weights of the position that `step` looks at in `cell`.
std::array<double, 4> cornerWeights(std::uint32_t cell, std::uint32_t step, const FitSettings& s)
{
    const glm::vec2 position = gpu::sgFitPosition(cell, step, s.seed, s.cornerFraction);
    std::array<double, 4> weights{};
    for (std::uint32_t c = 0; c < 4; ++c)
        weights[c] = double(gpu::sgFitCornerWeight(position, c));
    return weights;
}

struct InterpolatedLobe
{
    dvec3 axis;
    double axisLength; // before normalisation
    double present;    // sum of the weights of the texels that have the lobe
    double sharpness;
    dvec3 amplitude;
};

InterpolatedLobe interpolate(const LobeBlock& parameters, std::uint32_t lobe,
                             const glm::uvec4& texel, const std::array<double, 4>& weight)
{
    dvec3 axis(0.0), amplitude(0.0);
    double logSharpness = 0.0;
    double missing = 0.0;
    for (int c = 0; c < 4; ++c) {
        const double dropped = parameters.at(lobe, gpu::kSgFitDropped, texel[c]);
        const double share = weight[std::size_t(c)] * (1.0 - dropped);
        axis += share * parameters.at3(lobe, gpu::kSgFitAxis, texel[c]);
        logSharpness += share * parameters.at(lobe, gpu::kSgFitSharpness, texel[c]);
        amplitude += share * parameters.at3(lobe, gpu::kSgFitAmplitude, texel[c]);
        missing += weight[std::size_t(c)] * dropped;
    }
    const double length = std::max(glm::length(axis), double(gpu::kSgFitShortestAxis));
    const double present = std::max(1.0 - missing, double(gpu::kSgFitShortestAxis));
    return {axis / length, length, present, std::exp(logSharpness / present), amplitude};
}

struct LobeGradient
{
    dvec3 towards{0.0}; // sum of b d
    double sharpness = 0.0;
    dvec3 amplitude{0.0};
};

} // namespace

FitStateReference toReference(const FitState& state)
{
    FitStateReference out;
    out.step = state.step;
    out.parameters.assign(state.parameters.begin(), state.parameters.end());
    out.firstMoments.assign(state.firstMoments.begin(), state.firstMoments.end());
    out.secondMoments.assign(state.secondMoments.begin(), state.secondMoments.end());
    return out;
}

FitState fromReference(const FitStateReference& state)
{
    FitState out;
    out.step = state.step;
    const auto narrow = [](const std::vector<double>& from, std::vector<float>& to) {
        to.resize(from.size());
        std::transform(from.begin(), from.end(), to.begin(), [](double v) { return float(v); });
    };
    narrow(state.parameters, out.parameters);
    narrow(state.firstMoments, out.firstMoments);
    narrow(state.secondMoments, out.secondMoments);
    return out;
}

double FitCellGradients::loss() const
{
    return std::accumulate(losses.begin(), losses.end(), 0.0);
}

FitCellGradients sgFitCellsReference(const FitProblem& problem, const FitStateReference& state,
                                     const FitSettings& settings)
{
    const std::uint32_t directionCount = problem.directionCount();
    const std::uint32_t perStep = fitDirectionsPerStep(settings, directionCount);
    const std::uint32_t cellCount = problem.cells.cellCount;
    const std::uint32_t texelCount = problem.texelCount();
    const LobeBlock parameters{state.parameters, texelCount};
    FitCellGradients out;
    out.gradients.assign(std::size_t(problem.lobes) * gpu::kSgFitLobeFloats * cellCount, 0.0);
    out.losses.assign(cellCount, 0.0);
    std::vector<InterpolatedLobe> lobes(problem.lobes);
    std::vector<double> exponent(problem.lobes), value(problem.lobes);

    for (std::uint32_t cell = 0; cell < cellCount; ++cell) {
        // The position, and what its four texels know.
        const std::array<double, 4> weight = cornerWeights(cell, state.step, settings);
        const glm::uvec4 texel = problem.cells.cornersOf(cell);
        std::array<double, 4> known{};
        double mean = 0.0, trust = 0.0;
        for (std::size_t c = 0; c < 4; ++c) {
            const double scale = double(problem.scales[texel[int(c)]]);
            mean += weight[c] * std::abs(scale);
            known[c] = scale > 0.0 ? weight[c] : 0.0;
            trust += known[c];
        }
        for (double& k : known)
            k = trust > 0.0 ? k / trust : 0.0;
        for (std::uint32_t k = 0; k < problem.lobes; ++k)
            lobes[k] = interpolate(parameters, k, texel, weight);

        // Loss and gradient over the directions of this step.
        std::vector<LobeGradient> gradient(problem.lobes);
        const double cellWeight = trust / (mean * mean) * double(directionCount / perStep);
        for (std::uint32_t s = 0; s < perStep; ++s) {
            const std::uint32_t d =
                gpu::sgFitDirection(s, state.step, perStep, directionCount, settings.seed);
            const dvec3 direction = glm::normalize(dvec3(problem.directions[d]));
            dvec3 target(0.0), sum(0.0);
            for (std::size_t c = 0; c < 4; ++c)
                target +=
                    known[c] * dvec3(gpu::unpackRgb9e5(
                                   problem.images[std::size_t(d) * texelCount + texel[int(c)]]));
            for (std::uint32_t k = 0; k < problem.lobes; ++k) {
                const dvec3 chord = direction - lobes[k].axis;
                exponent[k] = -0.5 * lobes[k].sharpness * glm::dot(chord, chord);
                value[k] = std::exp(exponent[k]);
                sum += lobes[k].amplitude * value[k];
            }
            const double brightness = (target.x + target.y + target.z) / 3.0 / mean;
            const double sampleWeight = cellWeight * double(problem.directions[d].w) /
                                        (1.0 + double(settings.peakSoftening) * brightness);
            const dvec3 residual = sum - target;
            const dvec3 dSum = residual * sampleWeight;
            out.losses[cell] += 0.5 * glm::dot(dSum, residual);
            for (std::uint32_t k = 0; k < problem.lobes; ++k) {
                const double b = glm::dot(dSum, lobes[k].amplitude) * value[k];
                gradient[k].towards += direction * b;
                gradient[k].sharpness += b * exponent[k];
                gradient[k].amplitude += dSum * value[k];
            }
        }

        // Through the normalisation of the axis: only the part across it counts.
        for (std::uint32_t k = 0; k < problem.lobes; ++k) {
            const LobeGradient& g = gradient[k];
            const dvec3 across = g.towards - lobes[k].axis * glm::dot(lobes[k].axis, g.towards);
            const dvec3 dAxis = across * (lobes[k].sharpness / lobes[k].axisLength);
            const double components[gpu::kSgFitComponents] = {
                dAxis.x,       dAxis.y,       dAxis.z,      g.sharpness / lobes[k].present,
                g.amplitude.x, g.amplitude.y, g.amplitude.z};
            for (std::uint32_t c = 0; c < gpu::kSgFitComponents; ++c)
                out.gradients[gpu::sgFitIndex(k, c, cell, cellCount)] = components[c];
        }
    }
    return out;
}

std::vector<double> sgFitGatherReference(const FitProblem& problem, const FitCellGradients& cells,
                                         std::uint32_t step, const FitSettings& settings)
{
    const std::uint32_t texelCount = problem.texelCount();
    const std::uint32_t cellCount = problem.cells.cellCount;
    std::vector<double> gradient(std::size_t(problem.lobes) * gpu::kSgFitLobeFloats * texelCount,
                                 0.0);
    for (std::uint32_t cell = 0; cell < cellCount; ++cell) {
        const std::array<double, 4> weight = cornerWeights(cell, step, settings);
        const glm::uvec4 texel = problem.cells.cornersOf(cell);
        for (std::uint32_t lobe = 0; lobe < problem.lobes; ++lobe)
            for (std::uint32_t component = 0; component < gpu::kSgFitComponents; ++component)
                for (std::size_t c = 0; c < 4; ++c)
                    gradient[gpu::sgFitIndex(lobe, component, texel[int(c)], texelCount)] +=
                        weight[c] *
                        cells.gradients[gpu::sgFitIndex(lobe, component, cell, cellCount)];
    }
    return gradient;
}

} // namespace strandlight
