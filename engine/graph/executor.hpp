// Realises a plan: memory for transients, barriers, descriptors, one command buffer, one wait.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "engine/graph/graph_state.hpp"
#include "engine/vk/allocator.hpp"
#include "engine/vk/resource_state.hpp"

namespace strandlight {

// The Vulkan objects of a compiled graph; they live until the graph is destroyed.
class GraphResources
{
public:
    explicit GraphResources(RenderGraph::State& graph);

    std::uint32_t count() const { return std::uint32_t(buffers_.size()); }
    // Null where the plan does not use the resource.
    BufferState* buffer(std::uint32_t resource) const { return buffers_[resource]; }
    ImageState* image(std::uint32_t resource) const { return images_[resource]; }

    CpuImage readImage(std::uint32_t resource, std::uint32_t layer) const;
    std::vector<std::byte> readBuffer(std::uint32_t resource) const;

private:
    void createTransients();
    void bindTransients(const std::vector<std::uint32_t>& aliased);

    RenderGraph::State& graph_;
    Allocation arena_;
    std::deque<Buffer> ownedBuffers_; // outputs keep memory of their own
    std::deque<Image> ownedImages_;
    std::deque<BufferState> transientBuffers_;
    std::deque<ImageState> transientImages_;
    std::vector<BufferState*> buffers_; // [resources]
    std::vector<ImageState*> images_;   // [resources]
};

void executeGraph(RenderGraph::State& graph);

} // namespace strandlight
