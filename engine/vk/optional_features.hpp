// What a device may offer beyond the required features, and in words what is missing.
#pragma once

#include <string>

#include <volk.h>

#include "engine/vk/device_selection.hpp"

namespace strandlight {

// What kernels for matrix units (VK_KHR_cooperative_matrix) need.
struct MatrixSupport
{
    bool extension = false;   // of the device
    bool matrices = false;    // its features: cooperativeMatrix,
    bool halves = false;      // shaderFloat16
    bool memoryModel = false; // and vulkanMemoryModel
    bool compiler = false;    // GL_KHR_cooperative_matrix, which glslang has from 13.0 on
    std::string compilerVersion;
};
MatrixSupport matrixSupport(VkPhysicalDevice device, const DeviceFeatures& has);
// Everything that is missing, in one line; or that no kernel uses what is there.
std::string matrixUnitsText(const MatrixSupport& support);

// Tensors stored as halves: 16-bit storage buffers and texel buffers of halves. Empty: offered.
std::string missingForHalves(VkPhysicalDevice device, const DeviceFeatures& has);

} // namespace strandlight
