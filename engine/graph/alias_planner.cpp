#include "engine/graph/alias_planner.hpp"

#include <algorithm>
#include <numeric>

namespace strandlight {

namespace {

std::uint64_t alignUp(std::uint64_t value, std::uint64_t alignment)
{
    return (value + alignment - 1) / alignment * alignment;
}

} // namespace

MemoryPlan planMemory(const std::vector<MemoryRequest>& requests)
{
    MemoryPlan plan;
    plan.offsets.assign(requests.size(), 0);
    std::vector<std::size_t> order(requests.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return requests[a].bytes > requests[b].bytes;
    });

    std::vector<std::size_t> placed;
    for (const std::size_t index : order) {
        const MemoryRequest& request = requests[index];
        // Intervals of memory taken by those that live at the same time, from low to high.
        std::vector<std::pair<std::uint64_t, std::uint64_t>> taken;
        for (const std::size_t other : placed)
            if (requests[other].first <= request.last && request.first <= requests[other].last)
                taken.emplace_back(plan.offsets[other],
                                   plan.offsets[other] + requests[other].bytes);
        std::sort(taken.begin(), taken.end());
        std::uint64_t offset = 0;
        for (const auto& [begin, end] : taken) {
            if (alignUp(offset, request.alignment) + request.bytes <= begin)
                break;
            offset = std::max(offset, end);
        }
        plan.offsets[index] = alignUp(offset, request.alignment);
        plan.bytes = std::max(plan.bytes, plan.offsets[index] + request.bytes);
        placed.push_back(index);
    }
    return plan;
}

} // namespace strandlight
