#include "passes/pareto.hpp"

#include <cmath>

#include "engine/base/assert.hpp"

namespace strandlight {

std::vector<bool> paretoFront(std::span<const double> cost, std::span<const double> error)
{
    STRANDLIGHT_ASSERT_EQ(cost.size(), error.size());
    const auto counts = [&](std::size_t i) {
        return std::isfinite(cost[i]) && std::isfinite(error[i]);
    };
    std::vector<bool> front(cost.size());
    for (std::size_t i = 0; i < cost.size(); ++i) {
        front[i] = counts(i);
        for (std::size_t j = 0; j < cost.size() && front[i]; ++j) {
            const bool noWorse = cost[j] <= cost[i] && error[j] <= error[i];
            const bool better = cost[j] < cost[i] || error[j] < error[i];
            if (counts(j) && noWorse && better)
                front[i] = false;
        }
    }
    return front;
}

} // namespace strandlight
