// The Vulkan objects behind Context. Only engine/vk and engine/graph/executor include this.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include <volk.h>

#include "engine/vk/allocator.hpp"
#include "engine/vk/context.hpp"

namespace strandlight {

class PipelineStore;

struct VulkanState
{
    VulkanState() = default;
    ~VulkanState();
    VulkanState(const VulkanState&) = delete;
    VulkanState& operator=(const VulkanState&) = delete;

    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    bool debugUtils = false; // the extension is on
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queueFamily = 0;
    VkCommandPool commandPool = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties{};
    std::uint32_t subgroupSize = 0;
    bool cpuForms = false;
    DeviceInfo deviceInfo;
    std::unique_ptr<Allocator> allocator;
    std::unique_ptr<PipelineStore> pipelines;

    std::atomic<std::uint32_t> validationMessages{0};
    std::mutex validationMutex;
    std::string firstValidationMessage;

    // Records into a fresh command buffer, submits, waits. Throws VulkanError on failure, and when
    // the validation layers have spoken: a wrong program must not go on to write a file.
    void submit(const std::function<void(VkCommandBuffer)>& record);
    // Names for validation messages and captures; nothing without the debug extension.
    void beginLabel(VkCommandBuffer commands, const std::string& name) const;
    void endLabel(VkCommandBuffer commands) const;
    void nameObject(VkObjectType type, std::uint64_t handle, const std::string& name) const;

private:
    void submitAndWait(VkCommandBuffer commands);
};

// Full execution and memory barrier: everything before is visible to everything after.
void fullBarrier(VkCommandBuffer commands);

} // namespace strandlight
