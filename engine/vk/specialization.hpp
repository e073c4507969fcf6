// Specialisation constants 0, 1, 2, ..., 32 bits each, as Vulkan wants them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <volk.h>

namespace strandlight {

// Borrows the constants.
class Specialization
{
public:
    explicit Specialization(std::span<const std::uint32_t> constants)
    {
        for (std::uint32_t i = 0; i < constants.size(); ++i)
            entries_.push_back({i, i * 4, 4});
        info_ = {std::uint32_t(entries_.size()), entries_.data(), constants.size_bytes(),
                 constants.data()};
    }
    Specialization(const Specialization&) = delete;
    Specialization& operator=(const Specialization&) = delete;

    const VkSpecializationInfo& info() const { return info_; }

private:
    std::vector<VkSpecializationMapEntry> entries_;
    VkSpecializationInfo info_{};
};

} // namespace strandlight
