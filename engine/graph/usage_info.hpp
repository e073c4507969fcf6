// Vulkan's words for a use: stage, access, layout.
#pragma once

#include <volk.h>

#include "engine/graph/desc.hpp"

namespace strandlight {

struct UsageInfo
{
    VkPipelineStageFlags2 stage;
    VkAccessFlags2 access;
    VkImageLayout layout;
};

// Stages are as narrow as the kind of use allows; a graph pass may be compute or raster, so shader
// uses name both.
UsageInfo infoOf(Usage usage);

VkAccessFlags2 writesOnly(VkAccessFlags2 access);

} // namespace strandlight
