#include "engine/graph/executor.hpp"

#include <algorithm>

#include "engine/base/error.hpp"
#include "engine/graph/alias_planner.hpp"
#include "engine/vk/check.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

GraphResources::GraphResources(RenderGraph::State& graph)
    : graph_(graph), buffers_(graph.description.resources.size(), nullptr),
      images_(graph.description.resources.size(), nullptr)
{
    for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
        if (graph.importedBuffers[i])
            buffers_[i] = &graph.importedBuffers[i]->state();
        if (graph.importedImages[i])
            images_[i] = &graph.importedImages[i]->state();
    }
    createTransients();
}

void GraphResources::createTransients()
{
    std::vector<std::uint32_t> aliased;
    for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
        const ResourceDescription& resource = graph_.description.resources[i];
        if (!graph_.plan->resources[i].used || buffers_[i] || images_[i])
            continue;
        if (graph_.plan->resources[i].aliased) {
            aliased.push_back(i);
        } else if (resource.kind == ResourceKind::Buffer) {
            buffers_[i] =
                &ownedBuffers_.emplace_back(*graph_.context, resource.buffer.bytes, resource.name)
                     .state();
        } else {
            images_[i] =
                &ownedImages_.emplace_back(*graph_.context, resource.image, resource.name).state();
        }
    }
    if (!aliased.empty())
        bindTransients(aliased);
}

// The plan shares memory by the sizes of the description; here the same planner runs on what the
// driver asks for.
void GraphResources::bindTransients(const std::vector<std::uint32_t>& aliased)
{
    VulkanState& vulkan = graph_.context->vulkan();
    std::vector<MemoryRequest> requests;
    VkMemoryRequirements arena{0, 1, ~0u};
    for (const std::uint32_t i : aliased) {
        const ResourceDescription& resource = graph_.description.resources[i];
        VkMemoryRequirements needs{};
        if (resource.kind == ResourceKind::Buffer) {
            BufferState& state = transientBuffers_.emplace_back();
            state.vulkan = &vulkan;
            state.name = resource.name;
            state.bytes = resource.buffer.bytes;
            createBufferHandle(vulkan, state);
            vkGetBufferMemoryRequirements(vulkan.device, state.handle, &needs);
            buffers_[i] = &state;
        } else {
            ImageState& state = transientImages_.emplace_back();
            state.vulkan = &vulkan;
            state.name = resource.name;
            state.desc = resource.image;
            createImageHandle(vulkan, state);
            vkGetImageMemoryRequirements(vulkan.device, state.handle, &needs);
            images_[i] = &state;
        }
        // Buffers and images in one arena keep the granularity apart.
        needs.alignment =
            std::max(needs.alignment, vulkan.properties.limits.bufferImageGranularity);
        const std::uint64_t bytes =
            (needs.size + needs.alignment - 1) / needs.alignment * needs.alignment;
        const PlannedResource& planned = graph_.plan->resources[i];
        requests.push_back({bytes, needs.alignment, planned.firstPass, planned.lastPass});
        arena.alignment = std::max(arena.alignment, needs.alignment);
        arena.memoryTypeBits &= needs.memoryTypeBits;
    }
    const MemoryPlan memory = planMemory(requests);
    arena.size = memory.bytes;
    arena_ = vulkan.allocator->allocate(arena, MemoryUse::Device, "transients of a graph");
    for (std::size_t k = 0; k < aliased.size(); ++k) {
        const VkDeviceSize offset = arena_.offset() + memory.offsets[k];
        if (BufferState* state = buffers_[aliased[k]]) {
            check(vkBindBufferMemory(vulkan.device, state->handle, arena_.memory(), offset),
                  "vkBindBufferMemory");
        } else {
            ImageState& image = *images_[aliased[k]];
            check(vkBindImageMemory(vulkan.device, image.handle, arena_.memory(), offset),
                  "vkBindImageMemory");
            createImageView(image);
        }
    }
}

CpuImage GraphResources::readImage(std::uint32_t resource, std::uint32_t layer) const
{
    const ResourceDescription& described = graph_.description.resources.at(resource);
    if (!images_.at(resource) || !(described.output || described.imported))
        throw GraphError("'" + described.name + "' cannot be read: it is no output of this graph");
    return toCpuImage(described.image, downloadLayer(*images_[resource], layer));
}

std::vector<std::byte> GraphResources::readBuffer(std::uint32_t resource) const
{
    const ResourceDescription& described = graph_.description.resources.at(resource);
    if (!buffers_.at(resource) ||
        !(described.output || described.imported || described.hasContents))
        throw GraphError("'" + described.name + "' cannot be read: it is no output of this graph");
    if (Buffer* imported = graph_.importedBuffers[resource])
        return imported->download();
    for (const Buffer& owned : ownedBuffers_)
        if (&owned.state() == buffers_[resource])
            return owned.download();
    return {};
}

} // namespace strandlight
