#include "engine/vk/optional_features.hpp"

#include <vector>

namespace strandlight {

namespace {

// Of VK_KHR_cooperative_matrix; the headers that the engine is built with may be older.
struct CooperativeMatrixFeatures
{
    VkStructureType type = VkStructureType(1000506000);
    void* next = nullptr;
    VkBool32 cooperativeMatrix = VK_FALSE;
    VkBool32 robustBufferAccess = VK_FALSE;
};

std::string joined(const std::vector<std::string>& parts)
{
    std::string text;
    for (const std::string& part : parts)
        text += (text.empty() ? "" : ", ") + part;
    return text;
}

} // namespace

MatrixSupport matrixSupport(VkPhysicalDevice device, const DeviceFeatures& has)
{
    MatrixSupport support;
    support.extension = hasExtension(device, "VK_KHR_cooperative_matrix");
    support.halves = has.v12.shaderFloat16;
    support.memoryModel = has.v12.vulkanMemoryModel;
    support.compiler = STRANDLIGHT_GLSLANG_MATRICES;
    support.compilerVersion = STRANDLIGHT_GLSLANG_VERSION;
    if (support.extension) {
        CooperativeMatrixFeatures matrix;
        VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &matrix};
        vkGetPhysicalDeviceFeatures2(device, &features);
        support.matrices = matrix.cooperativeMatrix;
    }
    return support;
}

std::string matrixUnitsText(const MatrixSupport& support)
{
    std::vector<std::string> device;
    if (!support.extension)
        device.push_back("VK_KHR_cooperative_matrix");
    else if (!support.matrices)
        device.push_back("the feature cooperativeMatrix");
    if (!support.halves)
        device.push_back("the feature shaderFloat16");
    if (!support.memoryModel)
        device.push_back("the feature vulkanMemoryModel");
    std::vector<std::string> reasons;
    if (!device.empty())
        reasons.push_back("the device lacks " + joined(device));
    if (!support.compiler)
        reasons.push_back("glslang " + support.compilerVersion +
                          " of this build lacks GL_KHR_cooperative_matrix (13.0 has it)");
    if (reasons.empty())
        reasons.push_back("device and compiler offer them, no kernel is written for them");
    std::string text = "not used: " + reasons[0];
    for (std::size_t i = 1; i < reasons.size(); ++i)
        text += "; " + reasons[i];
    return text;
}

std::string missingForHalves(VkPhysicalDevice device, const DeviceFeatures& has)
{
    std::vector<std::string> missing;
    if (!has.v11.storageBuffer16BitAccess)
        missing.push_back("storageBuffer16BitAccess");
    if (!has.core.features.shaderStorageImageExtendedFormats)
        missing.push_back("shaderStorageImageExtendedFormats");
    for (const auto& [format, name] :
         {std::pair{VK_FORMAT_R16_SFLOAT, "R16_SFLOAT"},
          std::pair{VK_FORMAT_R16G16B16A16_SFLOAT, "R16G16B16A16_SFLOAT"}}) {
        VkFormatProperties properties{};
        vkGetPhysicalDeviceFormatProperties(device, format, &properties);
        if (!(properties.bufferFeatures & VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT))
            missing.push_back(std::string("storage texel buffers of ") + name);
    }
    return joined(missing);
}

} // namespace strandlight
