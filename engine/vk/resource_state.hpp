// The Vulkan halves of Buffer and Image. Only engine/vk and engine/graph/executor include this.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <volk.h>

#include "engine/base/image.hpp"
#include "engine/vk/allocator.hpp"
#include "engine/vk/image_desc.hpp"

namespace strandlight {

struct VulkanState;

struct BufferState
{
    ~BufferState();
    // View as a texel buffer, of `size` bytes from `offset` (0: to the end); made on first use.
    VkBufferView view(VkFormat format, std::uint64_t offset, std::uint64_t size);

    VulkanState* vulkan = nullptr;
    std::string name;
    std::uint64_t bytes = 0;
    VkBuffer handle = VK_NULL_HANDLE;
    Allocation memory;
    std::map<std::tuple<VkFormat, std::uint64_t, std::uint64_t>, VkBufferView> views;
};

struct ImageState
{
    ~ImageState();

    VulkanState* vulkan = nullptr;
    std::string name;
    ImageDesc desc;
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED; // between submits
    Allocation memory;
};

// Objects without memory: the executor binds transients into shared memory.
void createBufferHandle(VulkanState& vulkan, BufferState& state);
void createImageHandle(VulkanState& vulkan,
                       ImageState& state); // throws Error when the format cannot do it
void createImageView(ImageState& state);   // after the memory is bound

// A host-visible buffer for the length of one copy.
struct Staging
{
    Staging(VulkanState& vulkan, std::uint64_t bytes);
    std::byte* mapped() const { return state.memory.mapped(); }
    BufferState state;
};

// Raw bytes of one layer, through a staging buffer.
std::vector<std::byte> downloadLayer(ImageState& state, std::uint32_t layer);
CpuImage toCpuImage(const ImageDesc& desc, const std::vector<std::byte>& bytes);

} // namespace strandlight
