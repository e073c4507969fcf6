#include "compute_nn/sum.hpp"

#include <algorithm>
#include <string>

#include "compute_nn/tensor.hpp"
#include "engine/base/error.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

// Invocations of the first stage: enough to fill a device, few enough for one to add their results.
constexpr std::uint32_t kInvocations = 16384;
constexpr std::uint32_t kLargestCount = 1u << 29; // 2^31 bytes, as of tensors

// Of `count` floats by `invocations` (one, or a multiple of eight): turns that cover all quads.
gpu::SumPush pushOf(std::uint32_t count, std::uint32_t invocations, float scale)
{
    const std::uint32_t quads = (count + 3) / 4;
    return {count, (quads + invocations - 1) / invocations, invocations, scale};
}

} // namespace

BufferId addSumPass(RenderGraph& graph, std::string_view name, BufferId values, std::uint32_t count,
                    float scale)
{
    if (count == 0 || count > kLargestCount)
        throw Error("sum " + std::string(name) + ": " + std::to_string(count) + " values");
    PassBuilder pass = graph.addComputePass(name);
    const BufferId from = pass.read(values);
    const BufferId result = pass.write(graph.createBuffer(std::string(name) + " result", 4));
    const auto add = [&](BufferId source, BufferId to, const gpu::SumPush& push) {
        checkTripBudget("sum", push.turns);
        pass.dispatch(kernels::sum, {push.invocations, 1, 1}, push, {source, to});
    };
    if (count <= kInvocations) {
        add(from, result, pushOf(count, 1, scale));
        return result;
    }
    const BufferId parts =
        pass.write(graph.createBuffer(std::string(name) + " parts", kInvocations * 4));
    add(from, parts, pushOf(count, kInvocations, 1.0f));
    add(parts, result, pushOf(kInvocations, 1, scale));
    return result;
}

} // namespace strandlight
