// Sum of a buffer as passes of a graph: two stages in a fixed order, compensated. Twin:
// reference/sum.hpp
#pragma once

#include <string_view>

#include "engine/graph/render_graph.hpp"

namespace strandlight {

// values [count] -> [1]: scale times their sum, within 1e-7 of the sum of their magnitudes. Throws
// Error beyond 2^29 values.
BufferId addSumPass(RenderGraph& graph, std::string_view name, BufferId values, std::uint32_t count,
                    float scale = 1.0f);

} // namespace strandlight
