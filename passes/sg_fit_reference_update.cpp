// The update half of the CPU twin: smoothness and Adam. shaders/sg_fit/sg_fit_update.comp
// Kingma and Ba. Adam: A Method for Stochastic Optimization. 2015
#include <algorithm>
#include <cmath>

#include "passes/sg_fit_reference.hpp"

namespace strandlight {
namespace {

// Adds d/dp of smoothness/2 * (difference to each neighbour that has the lobe)^2, per lobe and
// texel.
void addSmoothness(const FitProblem& problem, const LobeBlock& parameters, double smoothness,
                   std::uint32_t lobe, std::uint32_t texel, double gradient[gpu::kSgFitComponents])
{
    for (std::size_t n = 0; n < 4; ++n) {
        const std::uint32_t other = problem.cells.neighbours[n * problem.texelCount() + texel];
        if (other == gpu::kSgFitNone || parameters.at(lobe, gpu::kSgFitDropped, other) != 0.0)
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
            if (parameters.at(lobe, gpu::kSgFitDropped, texel) != 0.0)
                continue;
            const auto index = [&](std::uint32_t component) {
                return gpu::sgFitIndex(lobe, component, texel, texelCount);
            };
            const double scale = std::abs(double(problem.scales[texel]));
            glm::dvec3 axis = parameters.at3(lobe, gpu::kSgFitAxis, texel);
            const glm::dvec3 amplitude = parameters.at3(lobe, gpu::kSgFitAmplitude, texel);

            double gradient[gpu::kSgFitComponents];
            for (std::uint32_t c = 0; c < gpu::kSgFitComponents; ++c)
                gradient[c] = gathered[index(c)] * (c < gpu::kSgFitAmplitude ? 1.0 : scale);
            addSmoothness(problem, parameters, fitSmoothness(settings, state.step), lobe, texel,
                          gradient);
            glm::dvec3 dAxis(gradient[0], gradient[1], gradient[2]);
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
            axis = glm::normalize(glm::dvec3(next[0], next[1], next[2]));
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
