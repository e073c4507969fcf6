// A plain directed graph of passes: cull from the roots, order, report cycles. Knows nothing of
// GPUs.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/graph/description.hpp"

namespace strandlight {

// needs[i]: passes that must run before pass i.
std::vector<std::vector<std::uint32_t>> findDependencies(const GraphDescription& description);

// Passes whose work reaches an output, an import or a kept pass.
std::vector<bool> findLivePasses(const GraphDescription& description,
                                 const std::vector<std::vector<std::uint32_t>>& needs);

// Live passes so that each follows what it needs; among the free ones the earliest declared runs
// first, so the order is the user's own unless it cannot be. Throws GraphError naming the passes of
// a cycle.
std::vector<std::uint32_t> orderPasses(const GraphDescription& description,
                                       const std::vector<std::vector<std::uint32_t>>& needs,
                                       const std::vector<bool>& live);

} // namespace strandlight
