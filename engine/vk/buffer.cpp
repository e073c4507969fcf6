#include "engine/vk/buffer.hpp"

#include <utility>

#include "engine/base/assert.hpp"
#include "engine/vk/check.hpp"
#include "engine/vk/context.hpp"
#include "engine/vk/resource_state.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

Staging::Staging(VulkanState& vulkan, std::uint64_t bytes)
{
    state.vulkan = &vulkan;
    state.name = "staging";
    state.bytes = bytes;
    createBufferHandle(vulkan, state);
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(vulkan.device, state.handle, &needs);
    state.memory = vulkan.allocator->allocate(needs, MemoryUse::Staging, state.name);
    check(vkBindBufferMemory(vulkan.device, state.handle, state.memory.memory(),
                             state.memory.offset()),
          "vkBindBufferMemory");
}

BufferState::~BufferState()
{
    for (const auto& [range, view] : views)
        vkDestroyBufferView(vulkan->device, view, nullptr);
    if (handle)
        vkDestroyBuffer(vulkan->device, handle, nullptr);
}

VkBufferView BufferState::view(VkFormat format, std::uint64_t offset, std::uint64_t size)
{
    VkBufferView& view = views[{format, offset, size}];
    if (!view) {
        VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
        info.buffer = handle;
        info.format = format;
        info.offset = offset;
        info.range = size ? size : VK_WHOLE_SIZE;
        check(vkCreateBufferView(vulkan->device, &info, nullptr, &view), "vkCreateBufferView");
    }
    return view;
}

void createBufferHandle(VulkanState& vulkan, BufferState& state)
{
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    // Texel buffer views of 16-byte texels need whole texels: round up, the tail stays zero.
    info.size = (state.bytes + 15) / 16 * 16;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    check(vkCreateBuffer(vulkan.device, &info, nullptr, &state.handle), "vkCreateBuffer");
    vulkan.nameObject(VK_OBJECT_TYPE_BUFFER, std::uint64_t(state.handle), state.name);
}

Buffer::Buffer(Context& context, std::uint64_t bytes, std::string name)
    : state_(std::make_unique<BufferState>())
{
    STRANDLIGHT_ASSERT(bytes > 0);
    VulkanState& vulkan = context.vulkan();
    state_->vulkan = &vulkan;
    state_->name = std::move(name);
    state_->bytes = bytes;
    createBufferHandle(vulkan, *state_);
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(vulkan.device, state_->handle, &needs);
    state_->memory = vulkan.allocator->allocate(needs, MemoryUse::Device, state_->name);
    check(vkBindBufferMemory(vulkan.device, state_->handle, state_->memory.memory(),
                             state_->memory.offset()),
          "vkBindBufferMemory");
    vulkan.submit([&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, state_->handle, 0, VK_WHOLE_SIZE, 0);
        fullBarrier(commands);
    });
}

Buffer::Buffer() noexcept = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;
Buffer::~Buffer() = default;

std::uint64_t Buffer::bytes() const
{
    return state_->bytes;
}
const std::string& Buffer::name() const
{
    return state_->name;
}

void Buffer::upload(std::span<const std::byte> data, std::uint64_t offset)
{
    STRANDLIGHT_ASSERT(offset + data.size() <= state_->bytes);
    if (data.empty())
        return;
    if (std::byte* mapped = state_->memory.mapped()) {
        std::memcpy(mapped + offset, data.data(), data.size());
        return;
    }
    VulkanState& vulkan = *state_->vulkan;
    Staging staging(vulkan, data.size());
    std::memcpy(staging.mapped(), data.data(), data.size());
    vulkan.submit([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, offset, data.size()};
        vkCmdCopyBuffer(commands, staging.state.handle, state_->handle, 1, &region);
        fullBarrier(commands);
    });
}

std::vector<std::byte> Buffer::download() const
{
    std::vector<std::byte> out(state_->bytes);
    if (const std::byte* mapped = state_->memory.mapped()) {
        std::memcpy(out.data(), mapped, out.size());
        return out;
    }
    VulkanState& vulkan = *state_->vulkan;
    Staging staging(vulkan, out.size());
    vulkan.submit([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, out.size()};
        vkCmdCopyBuffer(commands, state_->handle, staging.state.handle, 1, &region);
        fullBarrier(commands);
    });
    std::memcpy(out.data(), staging.mapped(), out.size());
    return out;
}

} // namespace strandlight
