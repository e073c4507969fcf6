// A tensor on the device: planar [N,C,H,W] in a graph buffer, or a range of the channels of
// one. Concatenation is two layers writing two ranges of one buffer.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "compute_nn/tensor_desc.hpp"
#include "engine/graph/render_graph.hpp"
#include "shaders/shared/nn_types.h"

namespace strandlight {

struct TensorId
{
    BufferId buffer;
    TensorDesc desc;                  // of the range
    std::uint32_t firstChannel = 0;   // in the buffer
    std::uint32_t bufferChannels = 1; // of the whole buffer
    std::uint32_t firstImage = 0;     // in the buffer
    std::uint64_t boundFrom = 0;      // what is bound of the buffer: bytes from here on,
    std::uint64_t boundBytes = 0;     // so many; 0: all (tensor_parts.hpp)
    Element element = Element::Float;

    bool whole() const { return firstImage == 0 && firstChannel == 0 && bufferChannels == desc.c; }
    Binding binding(BufferId version) const { return {version, boundFrom, boundBytes}; }
    std::uint64_t firstElement() const
    {
        return (std::uint64_t(firstImage) * bufferChannels + firstChannel) * desc.pixels();
    }
    gpu::TensorView view() const
    {
        return {std::uint32_t(firstElement() - boundFrom / elementBytes(element)),
                bufferChannels * desc.pixels(), desc.h, desc.w};
    }
    // The same tensor after a pass has written it.
    TensorId as(BufferId version) const
    {
        TensorId copy = *this;
        copy.buffer = version;
        return copy;
    }
};

// A transient tensor; its contents are undefined until a pass writes them. Throws Error beyond 2^31
// bytes.
TensorId createTensor(RenderGraph& graph, std::string_view name, const TensorDesc& desc,
                      Element element = Element::Float);

// A transient tensor with these values [N,C,H,W].
TensorId uploadTensor(RenderGraph& graph, std::string_view name, const TensorDesc& desc,
                      std::span<const float> values);

// A whole tensor in a buffer that exists. Throws Error when the sizes differ.
TensorId tensorOf(const RenderGraph& graph, BufferId buffer, const TensorDesc& desc);

// `count` channels of a whole tensor from `first`.
TensorId channelRange(const TensorId& tensor, std::uint32_t first, std::uint32_t count);

// lavapipe ends every loop of an invocation after 65,535 turns in all, without a message. Half of
// that is our budget; throws Error naming the kernel beyond it.
void checkTripBudget(const char* kernel, std::uint64_t trips);

} // namespace strandlight
