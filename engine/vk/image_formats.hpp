// Format -> VkFormat, and pixels to and from RGBA fp32.
#pragma once

#include <cstddef>
#include <span>

#include <volk.h>

#include <glm/glm.hpp>

#include "engine/vk/image_desc.hpp"

namespace strandlight {

VkFormat toVulkan(Format format);
VkImageAspectFlags aspectOf(Format format);
void encodePixel(Format format, const glm::vec4& value, std::byte* out);
glm::vec4 decodePixel(Format format, const std::byte* in);

} // namespace strandlight
