#include "compute_nn/loss.hpp"

#include <algorithm>
#include <string>

#include "compute_nn/sum.hpp"
#include "compute_nn/tensor_parts.hpp"
#include "engine/base/assert.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

LossResult addLossPass(RenderGraph& graph, std::string_view name, LossKind kind,
                       const TensorId& prediction, const TensorId& target,
                       const std::optional<LossWeights>& weights)
{
    STRANDLIGHT_ASSERT(prediction.whole() && target.whole());
    STRANDLIGHT_ASSERT(prediction.desc == target.desc);
    const std::uint32_t count = std::uint32_t(prediction.desc.elements());
    // Few enough chunks for one invocation to add them.
    const std::uint32_t chunk = std::max(64u, (count + 16383) / 16384);
    const std::uint32_t chunks = (count + chunk - 1) / chunk;
    checkTripBudget("loss", chunk);

    const std::string title(name);
    TensorId gradient = createTensor(graph, title + " gradient", prediction.desc);
    PassBuilder pass = graph.addComputePass(name);
    const BufferId p = pass.read(prediction.buffer);
    const BufferId t = pass.read(target.buffer);
    const BufferId w = weights ? pass.read(weights->buffer) : p;
    const BufferId dP = pass.write(gradient.buffer);
    const BufferId sums = pass.write(graph.createBuffer(title + " chunks", chunks * 4));
    gpu::LossPush push{count,
                       chunk,
                       0,
                       weights ? weights->stride : 1,
                       weights ? weights->count : 1,
                       float(1.0 / count)};
    const std::uint32_t perPart = flatImagesPerPart(graph, name, chunks, chunk);
    for (; push.firstChunk < chunks; push.firstChunk += perPart) {
        const std::uint32_t first = push.firstChunk * chunk;
        push.count = std::min(count - first, perPart * chunk);
        const auto part = [&](BufferId tensor) {
            return flatPart(tensor, count, 1, first, push.count);
        };
        pass.dispatch(kernels::loss, {(push.count + chunk - 1) / chunk, 1, 1}, push,
                      {part(p), part(t), weights ? Binding(w) : part(p), part(dP), sums},
                      {std::uint32_t(kind), weights ? 1u : 0u});
    }
    return {addSumPass(graph, title + " sum", sums, chunks, push.scale), gradient.as(dP)};
}

} // namespace strandlight
