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
    double sharpness;
    dvec3 amplitude;
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
    dvec3 at3(std::uint32_t lobe, std::uint32_t component, std::uint32_t texel) const
    {
        return {at(lobe, component, texel), at(lobe, component + 1, texel),
                at(lobe, component + 2, texel)};
    }
};

InterpolatedLobe interpolate(const LobeBlock& parameters, std::uint32_t lobe,
                             const glm::uvec4& texel, const std::array<double, 4>& weight)
{
    dvec3 axis(0.0), amplitude(0.0);
    double logSharpness = 0.0;
    for (int c = 0; c < 4; ++c) {
        axis += weight[std::size_t(c)] * parameters.at3(lobe, gpu::kSgFitAxis, texel[c]);
        logSharpness +=
            weight[std::size_t(c)] * parameters.at(lobe, gpu::kSgFitSharpness, texel[c]);
        amplitude += weight[std::size_t(c)] * parameters.at3(lobe, gpu::kSgFitAmplitude, texel[c]);
    }
    const double length = std::max(glm::length(axis), double(gpu::kSgFitShortestAxis));
    return {axis / length, length, std::exp(logSharpness), amplitude};
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
                dAxis.x,       dAxis.y,       dAxis.z,      g.sharpness,
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

namespace {

// Adds d/dp of smoothness/2 * (difference to each neighbour)^2, per lobe and texel.
void addSmoothness(const FitProblem& problem, const LobeBlock& parameters, double smoothness,
                   std::uint32_t lobe, std::uint32_t texel, double gradient[gpu::kSgFitComponents])
{
    for (std::size_t n = 0; n < 4; ++n) {
        const std::uint32_t other = problem.cells.neighbours[n * problem.texelCount() + texel];
        if (other == gpu::kSgFitNone)
            continue;
        const double both = 0.5 * (std::abs(double(problem.scales[texel])) +
                                   std::abs(double(problem.scales[other])));
        for (std::uint32_t c = 0; c < gpu::kSgFitComponents; ++c) {
            const double weight = c < gpu::kSgFitSharpness ? double(gpu::kSgFitSmoothAxis)
                                  : c < gpu::kSgFitAmplitude
                                      ? double(gpu::kSgFitSmoothSharpness)
                                      : double(gpu::kSgFitSmoothAmplitude) / both;
            gradient[c] += smoothness * weight *
                           (parameters.at(lobe, c, texel) - parameters.at(lobe, c, other));
        }
    }
}

} // namespace

void sgFitUpdateReference(const FitProblem& problem, const FitCellGradients& cells,
                          const FitSettings& settings, FitStateReference& state)
{
    const std::uint32_t texelCount = problem.texelCount();
    const std::vector<double> gathered = sgFitGatherReference(problem, cells, state.step, settings);
    const std::vector<double> before = state.parameters;
    const LobeBlock parameters{before, texelCount};
    const double rate = fitLearningRate(settings, state.step);
    const double t = double(state.step) + 1.0;
    const double correction1 = 1.0 / (1.0 - std::pow(double(gpu::kSgFitBeta1), t));
    const double correction2 = 1.0 / (1.0 - std::pow(double(gpu::kSgFitBeta2), t));

    for (std::uint32_t lobe = 0; lobe < problem.lobes; ++lobe) {
        for (std::uint32_t texel = 0; texel < texelCount; ++texel) {
            const auto index = [&](std::uint32_t component) {
                return gpu::sgFitIndex(lobe, component, texel, texelCount);
            };
            const double scale = std::abs(double(problem.scales[texel]));
            dvec3 axis = parameters.at3(lobe, gpu::kSgFitAxis, texel);
            const dvec3 amplitude = parameters.at3(lobe, gpu::kSgFitAmplitude, texel);

            double gradient[gpu::kSgFitComponents];
            for (std::uint32_t c = 0; c < gpu::kSgFitComponents; ++c)
                gradient[c] = gathered[index(c)] * (c < gpu::kSgFitAmplitude ? 1.0 : scale);
            addSmoothness(problem, parameters, fitSmoothness(settings, state.step), lobe, texel,
                          gradient);
            dvec3 dAxis(gradient[0], gradient[1], gradient[2]);
            dAxis -= axis * glm::dot(axis, dAxis);
            for (int c = 0; c < 3; ++c)
                gradient[c] = dAxis[c];

            // Adam, one second moment per group.
            const double squares[gpu::kSgFitGroups] = {
                glm::dot(dAxis, dAxis) / 2.0, gradient[3] * gradient[3],
                (gradient[4] * gradient[4] + gradient[5] * gradient[5] +
                 gradient[6] * gradient[6]) /
                    3.0};
            const double brightest = std::max({amplitude.x, amplitude.y, amplitude.z});
            const double amplitudeStep = double(gpu::kSgFitAmplitudeBase) * scale +
                                         double(gpu::kSgFitAmplitudeRelative) * brightest;
            double rates[gpu::kSgFitGroups] = {rate, rate, rate * amplitudeStep};
            for (std::uint32_t g = 0; g < gpu::kSgFitGroups; ++g) {
                double& v = state.secondMoments[(std::size_t(lobe) * texelCount + texel) *
                                                    gpu::kSgFitMomentFloats +
                                                g];
                v = double(gpu::kSgFitBeta2) * v + (1.0 - double(gpu::kSgFitBeta2)) * squares[g];
                rates[g] /= std::sqrt(v * correction2) + double(gpu::kSgFitAdamEpsilon);
            }
            double next[gpu::kSgFitComponents];
            for (std::uint32_t c = 0; c < gpu::kSgFitComponents; ++c) {
                double& m = state.firstMoments[index(c)];
                m = double(gpu::kSgFitBeta1) * m + (1.0 - double(gpu::kSgFitBeta1)) * gradient[c];
                const std::uint32_t group = c < gpu::kSgFitSharpness   ? 0
                                            : c < gpu::kSgFitAmplitude ? 1
                                                                       : 2;
                next[c] = parameters.at(lobe, c, texel) - rates[group] * m * correction1;
            }
            axis = glm::normalize(dvec3(next[0], next[1], next[2]));
            for (std::uint32_t c = 0; c < 3; ++c)
                state.parameters[index(c)] = axis[int(c)];
            state.parameters[index(3)] = std::clamp(next[3], double(problem.minimumLogSharpness),
                                                    double(problem.maximumLogSharpness));
            for (std::uint32_t c = gpu::kSgFitAmplitude; c < gpu::kSgFitComponents; ++c)
                state.parameters[index(c)] = std::max(next[c], 0.0);
        }
    }
    ++state.step;
}

SgField fitLobesReference(const FitProblem& problem, const FitState& start,
                          const FitSettings& settings)
{
    FitStateReference state = toReference(start);
    while (state.step < settings.steps)
        sgFitUpdateReference(problem, sgFitCellsReference(problem, state, settings), settings,
                             state);
    return fieldFromState(problem, fromReference(state));
}

} // namespace strandlight
