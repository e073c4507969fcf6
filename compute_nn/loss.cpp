#include "compute_nn/loss.hpp"

#include <algorithm>
#include <string>

#include "engine/base/assert.hpp"
#include "kernels.gen.hpp"

namespace strandlight {

LossResult addLossPass(RenderGraph& graph, std::string_view name, LossKind kind,
                       const TensorId& prediction, const TensorId& target,
                       const std::optional<LossWeights>& weights)
{
    STRANDLIGHT_ASSERT(prediction.whole() && target.whole());
    STRANDLIGHT_ASSERT(prediction.desc == target.desc);
    const std::uint32_t count = std::uint32_t(prediction.desc.elements());
    // Both stages loop: the chunk grows only when there would be too many chunks.
    const std::uint32_t chunk = std::max(64u, (count + 16383) / 16384);
    const std::uint32_t chunks = (count + chunk - 1) / chunk;
    checkTripBudget("loss", chunk);
    checkTripBudget("loss_sum", chunks);

    const std::string title(name);
    TensorId gradient = createTensor(graph, title + " gradient", prediction.desc);
    PassBuilder pass = graph.addComputePass(name);
    const BufferId p = pass.read(prediction.buffer);
    const BufferId t = pass.read(target.buffer);
    const BufferId w = weights ? pass.read(weights->buffer) : p;
    const BufferId dP = pass.write(gradient.buffer);
    const BufferId sums = pass.write(graph.createBuffer(title + " chunks", chunks * 4));
    const BufferId value = pass.write(graph.createBuffer(title + " value", 4));
    const gpu::LossPush push{count, chunk, weights ? weights->stride : 1,
                             weights ? weights->count : 1, float(1.0 / count)};
    pass.dispatch(kernels::loss, {chunks, 1, 1}, push, {p, t, w, dP, sums},
                  {std::uint32_t(kind), weights ? 1u : 0u});
    pass.dispatch(kernels::loss_sum, {1, 1, 1}, push, {sums, value});
    return {value, gradient.as(dP)};
}

} // namespace strandlight
