// First and last use -> memory offsets, so that resources that never live together share memory. No
// Vulkan.
#pragma once

#include <cstdint>
#include <vector>

namespace strandlight {

struct MemoryRequest
{
    std::uint64_t bytes = 0;
    std::uint64_t alignment = 1;
    std::uint32_t first = 0; // inclusive positions in the order of passes
    std::uint32_t last = 0;
};

struct MemoryPlan
{
    std::vector<std::uint64_t> offsets; // [requests]
    std::uint64_t bytes = 0;
};

// Largest first, each at the lowest offset that is free over its whole life.
MemoryPlan planMemory(const std::vector<MemoryRequest>& requests);

} // namespace strandlight
