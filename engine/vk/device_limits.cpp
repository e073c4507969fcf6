#include "engine/vk/device_limits.hpp"

#include "engine/vk/context.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

std::uint32_t maxSharedBytes(const Context& context)
{
    return context.vulkan().properties.limits.maxComputeSharedMemorySize;
}

} // namespace strandlight
