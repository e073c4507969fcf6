#include "engine/graph/pass_timer.hpp"

#include "engine/vk/check.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

PassTimer::PassTimer(VulkanState& vulkan, std::uint32_t spans) : vulkan_(vulkan), count_(spans + 1)
{
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = count_;
    check(vkCreateQueryPool(vulkan.device, &info, nullptr, &pool_), "vkCreateQueryPool");
}

PassTimer::~PassTimer()
{
    vkDestroyQueryPool(vulkan_.device, pool_, nullptr);
}

void PassTimer::reset(VkCommandBuffer commands)
{
    vkCmdResetQueryPool(commands, pool_, 0, count_);
}

void PassTimer::mark(VkCommandBuffer commands, std::uint32_t index)
{
    fullBarrier(commands);
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, index);
}

std::vector<double> PassTimer::milliseconds() const
{
    std::vector<std::uint64_t> ticks(count_);
    check(vkGetQueryPoolResults(vulkan_.device, pool_, 0, count_, ticks.size() * 8, ticks.data(), 8,
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    std::vector<double> out;
    for (std::uint32_t i = 0; i + 1 < count_; ++i)
        out.push_back(double(ticks[i + 1] - ticks[i]) * vulkan_.properties.limits.timestampPeriod *
                      1e-6);
    return out;
}

} // namespace strandlight
