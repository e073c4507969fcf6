// Which devices there are, whether they offer what the engine needs, and why not.
#pragma once

#include <string>
#include <vector>

#include <volk.h>

#include "engine/vk/context.hpp"

namespace strandlight {

bool hasExtension(VkPhysicalDevice device, const char* name);

DeviceInfo describeDevice(VkPhysicalDevice device);

// `wanted`: "", an index in the loader's order, or part of a name. Discrete before integrated
// before virtual before cpu. Throws VulkanError listing every device with the reasons why it was
// refused.
VkPhysicalDevice selectDevice(VkInstance instance, const std::string& wanted);

// The features that every kernel may rely on, and those of tensors stored as halves where asked
// for, for vkCreateDevice; the chain lives in the struct.
struct DeviceFeatures
{
    explicit DeviceFeatures(bool halfTensors);
    DeviceFeatures(const DeviceFeatures&) = delete; // the chain points into the struct
    DeviceFeatures& operator=(const DeviceFeatures&) = delete;
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
};

} // namespace strandlight
