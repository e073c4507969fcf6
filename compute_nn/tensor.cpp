#include "compute_nn/tensor.hpp"

#include <string>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"

namespace strandlight {

namespace {

// Kernels index with 32 signed bits.
constexpr std::uint64_t kMaximumBytes = std::uint64_t(1) << 31;
constexpr std::uint64_t kTripBudget = 32768;

void checkSize(std::string_view name, const TensorDesc& desc)
{
    if (desc.elements() == 0 || desc.bytes() > kMaximumBytes)
        throw Error("tensor " + std::string(name) + " " + shapeText(desc) + " has " +
                    std::to_string(desc.bytes()) + " bytes, not 4 to " +
                    std::to_string(kMaximumBytes));
}

} // namespace

TensorId createTensor(RenderGraph& graph, std::string_view name, const TensorDesc& desc,
                      Element element)
{
    checkSize(name, desc);
    // Whole words, as fills write them.
    const std::uint64_t bytes = (desc.bytes(element) + 3) / 4 * 4;
    TensorId tensor{graph.createBuffer(name, bytes), desc, 0, desc.c};
    tensor.element = element;
    return tensor;
}

TensorId uploadTensor(RenderGraph& graph, std::string_view name, const TensorDesc& desc,
                      std::span<const float> values)
{
    checkSize(name, desc);
    if (values.size() != desc.elements())
        throw Error("tensor " + std::string(name) + " " + shapeText(desc) + " was given " +
                    std::to_string(values.size()) + " values");
    return {graph.uploadBuffer(name, values), desc, 0, desc.c};
}

TensorId tensorOf(const RenderGraph& graph, BufferId buffer, const TensorDesc& desc)
{
    checkSize("of a buffer", desc);
    if (graph.desc(buffer).bytes < desc.bytes())
        throw Error("a buffer of " + std::to_string(graph.desc(buffer).bytes) +
                    " bytes does not hold the tensor " + shapeText(desc));
    return {buffer, desc, 0, desc.c};
}

TensorId channelRange(const TensorId& tensor, std::uint32_t first, std::uint32_t count)
{
    STRANDLIGHT_ASSERT(first + count <= tensor.desc.c && count > 0);
    TensorId range = tensor;
    range.firstChannel += first;
    range.desc.c = count;
    return range;
}

void checkTripBudget(const char* kernel, std::uint64_t trips)
{
    if (trips > kTripBudget)
        throw Error(std::string("kernel ") + kernel + " would loop " + std::to_string(trips) +
                    " times in one invocation; the budget is " + std::to_string(kTripBudget));
}

} // namespace strandlight
