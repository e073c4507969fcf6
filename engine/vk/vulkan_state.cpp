#include "engine/vk/vulkan_state.hpp"

#include "engine/base/error.hpp"
#include "engine/vk/check.hpp"
#include "engine/vk/pipeline_store.hpp"

namespace strandlight {

VulkanState::~VulkanState()
{
    if (device) {
        vkDeviceWaitIdle(device);
        pipelines.reset();
        allocator.reset();
        vkDestroyFence(device, fence, nullptr);
        vkDestroyCommandPool(device, commandPool, nullptr);
        vkDestroyDevice(device, nullptr);
    }
    if (messenger)
        vkDestroyDebugUtilsMessengerEXT(instance, messenger, nullptr);
    if (instance)
        vkDestroyInstance(instance, nullptr);
}

void VulkanState::submit(const std::function<void(VkCommandBuffer)>& record)
{
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = commandPool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(device, &allocate, &commands), "vkAllocateCommandBuffers");
    try {
        VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
        record(commands);
        check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
        submitAndWait(commands);
    } catch (...) {
        vkFreeCommandBuffers(device, commandPool, 1, &commands);
        throw;
    }
    vkFreeCommandBuffers(device, commandPool, 1, &commands);
    if (validationMessages != 0) {
        std::lock_guard lock(validationMutex);
        throw VulkanError("validation: " + firstValidationMessage);
    }
}

void VulkanState::submitAndWait(VkCommandBuffer commands)
{
    VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    buffer.commandBuffer = commands;
    VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &buffer;
    check(vkQueueSubmit2(queue, 1, &info, fence), "vkQueueSubmit2");
    check(vkWaitForFences(device, 1, &fence, VK_TRUE, ~0ull), "vkWaitForFences");
    check(vkResetFences(device, 1, &fence), "vkResetFences");
}

void VulkanState::nameObject(VkObjectType type, std::uint64_t handle, const std::string& name) const
{
    if (!debugUtils)
        return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    vkSetDebugUtilsObjectNameEXT(device, &info);
}

void VulkanState::beginLabel(VkCommandBuffer commands, const std::string& name) const
{
    if (!debugUtils)
        return;
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = name.c_str();
    vkCmdBeginDebugUtilsLabelEXT(commands, &label);
}

void VulkanState::endLabel(VkCommandBuffer commands) const
{
    if (debugUtils)
        vkCmdEndDebugUtilsLabelEXT(commands);
}

void fullBarrier(VkCommandBuffer commands)
{
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
}

} // namespace strandlight
