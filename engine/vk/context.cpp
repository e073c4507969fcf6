#include "engine/vk/context.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "engine/base/error.hpp"
#include "engine/vk/check.hpp"
#include "engine/vk/device_selection.hpp"
#include "engine/vk/pipeline_store.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data,
                                         void* user)
{
    VulkanState& state = *static_cast<VulkanState*>(user);
    std::lock_guard lock(state.validationMutex);
    if (state.validationMessages++ == 0)
        state.firstValidationMessage = data->pMessage;
    return VK_FALSE;
}

bool hasLayer(const char* name)
{
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    for (const VkLayerProperties& layer : layers)
        if (std::strcmp(layer.layerName, name) == 0)
            return true;
    return false;
}

bool hasInstanceExtension(const char* name)
{
    std::uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> list(count);
    vkEnumerateInstanceExtensionProperties(nullptr, &count, list.data());
    for (const VkExtensionProperties& extension : list)
        if (std::strcmp(extension.extensionName, name) == 0)
            return true;
    return false;
}

void createInstance(VulkanState& state, bool validation)
{
    if (volkInitialize() != VK_SUCCESS)
        throw VulkanError("no Vulkan loader on this machine (install libvulkan1)");
    if (validation && !hasLayer(kValidationLayer))
        throw VulkanError(
            "validation was asked for, but its layer is missing (install vulkan-validationlayers)");

    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "strandlight";
    application.apiVersion = VK_API_VERSION_1_3;
    VkDebugUtilsMessengerCreateInfoEXT messages{
        VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messages.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messages.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messages.pfnUserCallback = onMessage;
    messages.pUserData = &state;
    const VkValidationFeatureEnableEXT enabled[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messages};
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enabled;
    // Also without validation: capture tools show our names and labels.
    const char* const extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    state.debugUtils = hasInstanceExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    info.enabledExtensionCount = state.debugUtils ? 1 : 0;
    info.ppEnabledExtensionNames = extensions;
    if (validation) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
    }
    check(vkCreateInstance(&info, nullptr, &state.instance), "vkCreateInstance");
    volkLoadInstance(state.instance);
    if (validation)
        check(vkCreateDebugUtilsMessengerEXT(state.instance, &messages, nullptr, &state.messenger),
              "vkCreateDebugUtilsMessengerEXT");
}

// One queue that does graphics and compute: the graph orders its passes, so a second one would buy
// nothing here.
std::uint32_t findQueueFamily(VkPhysicalDevice physical)
{
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & wanted) == wanted)
            return i;
    throw VulkanError("the device has no queue for graphics and compute");
}

void createDevice(VulkanState& state, const ContextSettings& settings)
{
    state.physical = selectDevice(state.instance, settings.device);
    state.deviceInfo = describeDevice(state.physical);
    state.queueFamily = findQueueFamily(state.physical);
    VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v11};
    vkGetPhysicalDeviceProperties2(state.physical, &properties);
    state.properties = properties.properties;
    if (settings.bindingBytes != 0) {
        state.properties.limits.maxStorageBufferRange = std::uint32_t(settings.bindingBytes);
        state.properties.limits.maxTexelBufferElements = std::uint32_t(settings.bindingBytes / 4);
    }
    state.subgroupSize = settings.subgroups ? v11.subgroupSize : 1;
    VkPhysicalDeviceFeatures has;
    vkGetPhysicalDeviceFeatures(state.physical, &has);
    // A CPU's forms store 64-bit values.
    state.cpuForms =
        state.deviceInfo.type == "cpu" && has.shaderInt64 == VK_TRUE && !settings.gpuForms;

    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = state.queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    DeviceFeatures features(state.deviceInfo.missingForHalves.empty());
    features.core.features.shaderInt64 = state.cpuForms;
    const char* const extensions[] = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = extensions;
    check(vkCreateDevice(state.physical, &info, nullptr, &state.device), "vkCreateDevice");
    vkGetDeviceQueue(state.device, state.queueFamily, 0, &state.queue);

    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = state.queueFamily;
    check(vkCreateCommandPool(state.device, &pool, nullptr, &state.commandPool),
          "vkCreateCommandPool");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(state.device, &fence, nullptr, &state.fence), "vkCreateFence");
    state.allocator =
        std::make_unique<Allocator>(state.physical, state.device, settings.memoryBudget);
    state.pipelines = std::make_unique<PipelineStore>(state, settings.pipelineCache);
}

} // namespace

Context::Context(std::unique_ptr<VulkanState> state) : state_(std::move(state)) {}
Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;
Context::~Context() = default;

Context Context::headless(const ContextSettings& settings)
{
    auto state = std::make_unique<VulkanState>();
    createInstance(*state, settings.validation);
    createDevice(*state, settings);
    return Context(std::move(state));
}

std::vector<DeviceInfo> Context::devices()
{
    VulkanState state;
    createInstance(state, false);
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(state.instance, &count, nullptr),
          "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(state.instance, &count, devices.data()),
          "vkEnumeratePhysicalDevices");
    std::vector<DeviceInfo> list;
    for (VkPhysicalDevice device : devices)
        list.push_back(describeDevice(device));
    return list;
}

const DeviceInfo& Context::device() const
{
    return state_->deviceInfo;
}
bool Context::cpuForms() const
{
    return state_->cpuForms;
}

std::uint32_t Context::subgroupSize() const
{
    return state_->subgroupSize;
}
std::uint64_t Context::maxStorageBufferBytes() const
{
    return state_->properties.limits.maxStorageBufferRange;
}
std::uint64_t Context::maxTensorBindingBytes() const
{
    const std::uint64_t elements = state_->properties.limits.maxTexelBufferElements;
    return std::min<std::uint64_t>(maxStorageBufferBytes(), elements * sizeof(float));
}
std::uint64_t Context::bytesAllocated() const
{
    return state_->allocator->bytesAllocated();
}
std::uint64_t Context::peakBytesAllocated() const
{
    return state_->allocator->peakBytesAllocated();
}
std::uint32_t Context::pipelinesCreated() const
{
    return state_->pipelines->created();
}
std::uint32_t Context::validationMessages() const
{
    return state_->validationMessages;
}
std::string Context::firstValidationMessage() const
{
    std::lock_guard lock(state_->validationMutex);
    return state_->firstValidationMessage;
}

} // namespace strandlight
