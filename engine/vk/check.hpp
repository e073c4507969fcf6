// Every VkResult goes through here.
#pragma once

#include <volk.h>

namespace strandlight {

const char* toString(VkResult result);

// Throws VulkanError("<what>: VK_ERROR_...") unless the call succeeded.
void check(VkResult result, const char* what);

} // namespace strandlight
