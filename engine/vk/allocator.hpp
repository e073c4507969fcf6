// Device memory in large blocks, handed out in pieces under a budget.
// The budget is ours to keep: lavapipe accepts far more than the machine has and never reports out
// of memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <volk.h>

namespace strandlight {

class Allocator;

// A piece of device memory; returns to its allocator on destruction.
class Allocation
{
public:
    Allocation() = default;
    Allocation(Allocation&& other) noexcept { *this = std::move(other); }
    Allocation& operator=(Allocation&& other) noexcept;
    ~Allocation() { reset(); }
    void reset();

    VkDeviceMemory memory() const { return memory_; }
    VkDeviceSize offset() const { return offset_; }
    VkDeviceSize bytes() const { return bytes_; }
    std::byte* mapped() const { return mapped_; } // null: not host-visible

private:
    friend class Allocator;
    Allocator* allocator_ = nullptr;
    std::uint32_t block_ = 0;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize offset_ = 0;
    VkDeviceSize bytes_ = 0;
    std::byte* mapped_ = nullptr;
};

enum class MemoryUse
{
    Device, // device-local; host-visible as well where the device offers it
    Staging // host-visible and coherent
};

class Allocator
{
public:
    Allocator(VkPhysicalDevice physical, VkDevice device, std::uint64_t budget);
    ~Allocator();
    Allocator(const Allocator&) = delete;
    Allocator& operator=(const Allocator&) = delete;

    // Throws VulkanError with the budget, what is in use and what was asked for, by the name of the
    // resource.
    Allocation allocate(const VkMemoryRequirements& requirements, MemoryUse use,
                        const std::string& name);

    std::uint64_t bytesAllocated() const { return used_; }
    std::uint64_t peakBytesAllocated() const { return peak_; }

private:
    friend class Allocation;
    struct Block
    {
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkDeviceSize bytes = 0;
        std::uint32_t type = 0;
        bool shared = false; // by small resources, and kept; else freed with its one resource
        std::byte* mapped = nullptr;
        std::map<VkDeviceSize, VkDeviceSize> free; // offset -> bytes, neighbours merged
    };

    std::uint32_t findType(std::uint32_t allowed, MemoryUse use) const;
    bool allocateFrom(std::uint32_t block, const VkMemoryRequirements& requirements,
                      Allocation& out);
    std::uint32_t addBlock(std::uint32_t type, VkDeviceSize bytes, const std::string& name);
    void release(const Allocation& piece);

    VkDevice device_;
    VkPhysicalDeviceMemoryProperties properties_{};
    VkDeviceSize granularity_ = 1;
    std::uint64_t budget_;
    std::uint64_t reserved_ = 0; // bytes of all blocks
    std::uint64_t used_ = 0;     // bytes handed out
    std::uint64_t peak_ = 0;
    std::vector<Block> blocks_;
};

} // namespace strandlight
