#include "engine/vk/allocator.hpp"

#include <algorithm>
#include <utility>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "engine/vk/check.hpp"

namespace strandlight {

namespace {

// Small resources share blocks of this size; larger ones get a block of their own that is freed
// with them.
constexpr VkDeviceSize kBlockBytes = VkDeviceSize(32) << 20;
constexpr VkDeviceSize kDedicatedBytes = VkDeviceSize(8) << 20;

VkDeviceSize alignUp(VkDeviceSize value, VkDeviceSize alignment)
{
    return (value + alignment - 1) / alignment * alignment;
}

} // namespace

Allocation& Allocation::operator=(Allocation&& other) noexcept
{
    reset();
    allocator_ = std::exchange(other.allocator_, nullptr);
    block_ = other.block_;
    memory_ = other.memory_;
    offset_ = other.offset_;
    bytes_ = other.bytes_;
    mapped_ = other.mapped_;
    return *this;
}

void Allocation::reset()
{
    if (allocator_)
        allocator_->release(*this);
    allocator_ = nullptr;
}

Allocator::Allocator(VkPhysicalDevice physical, VkDevice device, std::uint64_t budget)
    : device_(device)
{
    vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
    VkPhysicalDeviceProperties limits{};
    vkGetPhysicalDeviceProperties(physical, &limits);
    granularity_ = limits.limits.bufferImageGranularity;
    std::uint64_t heap = 0;
    for (std::uint32_t i = 0; i < properties_.memoryHeapCount; ++i)
        if (properties_.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            heap = std::max<std::uint64_t>(heap, properties_.memoryHeaps[i].size);
    budget_ = budget != 0 ? budget : heap / 10 * 8;
}

Allocator::~Allocator()
{
    for (const Block& block : blocks_)
        vkFreeMemory(device_, block.memory, nullptr);
}

std::uint32_t Allocator::findType(std::uint32_t allowed, MemoryUse use) const
{
    const VkMemoryPropertyFlags host =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags wanted =
        use == MemoryUse::Device ? VkMemoryPropertyFlags(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
                                 : host;
    for (std::uint32_t type = 0; type < properties_.memoryTypeCount; ++type)
        if ((allowed >> type & 1u) &&
            (properties_.memoryTypes[type].propertyFlags & wanted) == wanted)
            return type;
    throw VulkanError("no memory type fits what the device asks for");
}

Allocation Allocator::allocate(const VkMemoryRequirements& requirements, MemoryUse use,
                               const std::string& name)
{
    const std::uint32_t type = findType(requirements.memoryTypeBits, use);
    VkMemoryRequirements padded = requirements;
    padded.alignment = std::max({requirements.alignment, granularity_, VkDeviceSize(64)});
    padded.size = alignUp(requirements.size, padded.alignment);

    Allocation out;
    bool found = false;
    const bool shared = padded.size <= kDedicatedBytes;
    for (std::uint32_t i = 0; shared && i < blocks_.size() && !found; ++i)
        found = blocks_[i].shared && blocks_[i].type == type && allocateFrom(i, padded, out);
    if (!found) {
        const std::uint32_t block = addBlock(type, shared ? kBlockBytes : padded.size, name);
        blocks_[block].shared = shared;
        found = allocateFrom(block, padded, out);
        STRANDLIGHT_ASSERT(found);
    }
    out.allocator_ = this;
    used_ += out.bytes_;
    peak_ = std::max(peak_, used_);
    return out;
}

bool Allocator::allocateFrom(std::uint32_t index, const VkMemoryRequirements& requirements,
                             Allocation& out)
{
    Block& block = blocks_[index];
    for (auto range = block.free.begin(); range != block.free.end(); ++range) {
        const auto [start, bytes] = *range;
        const VkDeviceSize offset = alignUp(start, requirements.alignment);
        if (offset + requirements.size > start + bytes)
            continue;
        block.free.erase(range);
        if (offset > start)
            block.free[start] = offset - start;
        if (offset + requirements.size < start + bytes)
            block.free[offset + requirements.size] = start + bytes - offset - requirements.size;
        out.block_ = index;
        out.memory_ = block.memory;
        out.offset_ = offset;
        out.bytes_ = requirements.size;
        out.mapped_ = block.mapped ? block.mapped + offset : nullptr;
        return true;
    }
    return false;
}

std::uint32_t Allocator::addBlock(std::uint32_t type, VkDeviceSize bytes, const std::string& name)
{
    if (reserved_ + bytes > budget_)
        throw VulkanError("out of device memory for '" + name +
                          "': " + std::to_string(bytes >> 20) +
                          " MiB more would exceed the budget of " + std::to_string(budget_ >> 20) +
                          " MiB (" + std::to_string(reserved_ >> 20) + " MiB reserved)");
    Block block;
    block.bytes = bytes;
    block.type = type;
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = bytes;
    info.memoryTypeIndex = type;
    check(vkAllocateMemory(device_, &info, nullptr, &block.memory), "vkAllocateMemory");
    const VkMemoryPropertyFlags flags = properties_.memoryTypes[type].propertyFlags;
    if ((flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) &&
        (flags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT)) {
        void* mapped = nullptr;
        const VkResult result = vkMapMemory(device_, block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
        if (result != VK_SUCCESS)
            vkFreeMemory(device_, block.memory, nullptr);
        check(result, "vkMapMemory");
        block.mapped = static_cast<std::byte*>(mapped);
    }
    block.free[0] = bytes;
    reserved_ += bytes;
    for (std::uint32_t i = 0; i < blocks_.size(); ++i)
        if (!blocks_[i].memory) {
            blocks_[i] = std::move(block);
            return i;
        }
    blocks_.push_back(std::move(block));
    return std::uint32_t(blocks_.size() - 1);
}

void Allocator::release(const Allocation& piece)
{
    Block& block = blocks_[piece.block_];
    used_ -= piece.bytes_;
    auto [range, inserted] = block.free.emplace(piece.offset_, piece.bytes_);
    STRANDLIGHT_ASSERT(inserted);
    if (const auto next = std::next(range);
        next != block.free.end() && range->first + range->second == next->first) {
        range->second += next->second;
        block.free.erase(next);
    }
    if (range != block.free.begin()) {
        const auto previous = std::prev(range);
        if (previous->first + previous->second == range->first) {
            previous->second += range->second;
            block.free.erase(range);
        }
    }
    const bool empty = block.free.size() == 1 && block.free.begin()->second == block.bytes;
    if (empty && !block.shared) {
        vkFreeMemory(device_, block.memory, nullptr);
        reserved_ -= block.bytes;
        block = Block{};
    }
}

} // namespace strandlight
