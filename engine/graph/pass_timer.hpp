// Milliseconds of every pass or of all together, by timestamps.
#pragma once

#include <cstdint>
#include <vector>

#include <volk.h>

namespace strandlight {

struct VulkanState;

// One timestamp before the first span and one after each, each behind a full barrier: without it
// the software device reports the next pass's time.
class PassTimer
{
public:
    PassTimer(VulkanState& vulkan, std::uint32_t spans);
    ~PassTimer();
    PassTimer(const PassTimer&) = delete;
    PassTimer& operator=(const PassTimer&) = delete;

    void reset(VkCommandBuffer commands);
    void mark(VkCommandBuffer commands, std::uint32_t index);
    std::vector<double> milliseconds() const; // [spans], after the submit

private:
    VulkanState& vulkan_;
    std::uint32_t count_;
    VkQueryPool pool_ = VK_NULL_HANDLE;
};

} // namespace strandlight
