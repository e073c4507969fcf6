#include "compute_nn/adam.hpp"

#include <limits>

#include "engine/base/assert.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

constexpr float kAnyFinite = std::numeric_limits<float>::max();

} // namespace

void addAdamPass(RenderGraph& graph, ParameterIds& parameters, const AdamSettings& settings,
                 std::uint32_t step)
{
    STRANDLIGHT_ASSERT(step > 0);
    const std::uint32_t count = std::uint32_t(graph.desc(parameters.values).bytes / 4);
    // What the step would spread: a poisoned parameter may hide behind a clamp on its way to the
    // gradient, a poisoned moment never reaches one.
    parameters.checkFinite(graph, "parameters", parameters.values, 0, count, kAnyFinite);
    parameters.checkFinite(graph, "moment 1", parameters.moment1, 0, count, kAnyFinite);
    parameters.checkFinite(graph, "moment 2", parameters.moment2, 0, count, kAnyFinite);
    parameters.checkFinite(graph, "gradient", parameters.gradient, 0, count, kLargestGradient);

    const AdamStep now = adamStepConstants(settings, step);
    const gpu::AdamPush push{count,
                             float(now.stepSize),
                             float(now.inverseRootCorrection2),
                             float(settings.beta1),
                             float(settings.beta2),
                             float(1.0 - settings.beta1),
                             float(1.0 - settings.beta2),
                             float(settings.epsilon)};
    PassBuilder pass = graph.addComputePass("adam");
    const BufferId gradient = pass.read(parameters.gradient);
    const BufferId status = pass.read(parameters.status);
    const BufferId values = parameters.values = pass.write(parameters.values);
    const BufferId moment1 = parameters.moment1 = pass.write(parameters.moment1);
    const BufferId moment2 = parameters.moment2 = pass.write(parameters.moment2);
    const BufferId counters = parameters.counters = pass.write(parameters.counters);
    pass.dispatch(kernels::adam, {(count + 31) / 32 * 8, 1, 1}, push, // four elements each

                  {gradient, values, moment1, moment2, values, moment1, moment2, status, counters});
}

} // namespace strandlight
