#include "engine/vk/device_selection.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

#include "engine/base/error.hpp"
#include "engine/vk/check.hpp"
#include "engine/vk/optional_features.hpp"

namespace strandlight {

namespace {

// One row per feature: where it is, and what the engine does with it.
struct FeatureRow
{
    const char* name;
    VkBool32* (*get)(DeviceFeatures&);
};

const FeatureRow kRequired[] = {
    {"synchronization2 (barriers)", [](DeviceFeatures& f) { return &f.v13.synchronization2; }},
    {"dynamicRendering (raster passes)", [](DeviceFeatures& f) { return &f.v13.dynamicRendering; }},
    {"scalarBlockLayout (shared structs)",
     [](DeviceFeatures& f) { return &f.v12.scalarBlockLayout; }},
    {"maintenance4 (local size by specialisation constants)",
     [](DeviceFeatures& f) { return &f.v13.maintenance4; }},
    {"vertexPipelineStoresAndAtomics",
     [](DeviceFeatures& f) { return &f.core.features.vertexPipelineStoresAndAtomics; }},
    {"fragmentStoresAndAtomics",
     [](DeviceFeatures& f) { return &f.core.features.fragmentStoresAndAtomics; }},
};

// Of one raster pass: the hair's slices of depth.
constexpr std::uint32_t kColorTargets = 8;

const char* typeName(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "cpu";
    default:
        return "other";
    }
}

int rank(const DeviceInfo& info)
{
    static const char* const kOrder[] = {"discrete", "integrated", "virtual", "cpu"};
    const auto* found = std::find(std::begin(kOrder), std::end(kOrder), info.type);
    return int(found - std::begin(kOrder));
}

// A number is an index and nothing else: "1" must not match a name with a 1 in it.
bool isIndex(const std::string& text)
{
    return !text.empty() && std::all_of(text.begin(), text.end(),
                                        [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

} // namespace

bool hasExtension(VkPhysicalDevice device, const char* name)
{
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> list(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, list.data());
    return std::any_of(list.begin(), list.end(),
                       [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

DeviceFeatures::DeviceFeatures(bool halfTensors)
{
    core.pNext = &v11;
    v11.pNext = &v12;
    v12.pNext = &v13;
    for (const FeatureRow& row : kRequired)
        *row.get(*this) = VK_TRUE;
    v11.storageBuffer16BitAccess = halfTensors;
    core.features.shaderStorageImageExtendedFormats = halfTensors;
}

DeviceInfo describeDevice(VkPhysicalDevice device)
{
    VkPhysicalDeviceVulkan12Properties v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v12};
    vkGetPhysicalDeviceProperties2(device, &properties);
    DeviceInfo info;
    info.name = properties.properties.deviceName;
    info.driver = std::string(v12.driverName) + " " + v12.driverInfo;
    info.type = typeName(properties.properties.deviceType);
    if (properties.properties.apiVersion < VK_API_VERSION_1_3) {
        info.refusals.push_back(
            "offers Vulkan " +
            std::to_string(VK_API_VERSION_MAJOR(properties.properties.apiVersion)) + "." +
            std::to_string(VK_API_VERSION_MINOR(properties.properties.apiVersion)) +
            ", 1.3 is needed");
        return info;
    }
    DeviceFeatures has(false);
    vkGetPhysicalDeviceFeatures2(device, &has.core);
    info.matrixUnits = matrixUnitsText(matrixSupport(device, has));
    info.missingForHalves = missingForHalves(device, has);
    for (const FeatureRow& row : kRequired)
        if (!*row.get(has))
            info.refusals.push_back(std::string("lacks ") + row.name);
    const std::uint32_t targets = properties.properties.limits.maxColorAttachments;
    if (targets < kColorTargets)
        info.refusals.push_back("draws into " + std::to_string(targets) + " images at once, " +
                                std::to_string(kColorTargets) + " are needed");
    if (!hasExtension(device, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME))
        info.refusals.push_back("lacks " VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    return info;
}

VkPhysicalDevice selectDevice(VkInstance instance, const std::string& wanted)
{
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(instance, &count, devices.data()),
          "vkEnumeratePhysicalDevices");

    std::string report;
    VkPhysicalDevice best = VK_NULL_HANDLE;
    int bestRank = 100;
    for (std::uint32_t i = 0; i < count; ++i) {
        const DeviceInfo info = describeDevice(devices[i]);
        report += "\n  " + std::to_string(i) + ": " + info.name;
        for (const std::string& reason : info.refusals)
            report += "; " + reason;
        const bool matches = isIndex(wanted)
                                 ? wanted == std::to_string(i)
                                 : lower(info.name).find(lower(wanted)) != std::string::npos;
        if (matches && info.refusals.empty() && rank(info) < bestRank) {
            best = devices[i];
            bestRank = rank(info);
        }
    }
    if (best == VK_NULL_HANDLE)
        throw VulkanError(
            "no usable Vulkan device" + (wanted.empty() ? "" : " matches '" + wanted + "'") +
            (count ? "; there are:" + report
                   : "; none was found (install mesa-vulkan-drivers for the software device)"));
    return best;
}

} // namespace strandlight
