// How the convolution passes cut their work; internal to them.
#pragma once

#include <cstdint>

#include "engine/graph/render_graph.hpp"
#include "shaders/shared/nn_types.h"

namespace strandlight {

// Lanes that share a load in every convolution kernel.
inline constexpr std::uint32_t kConvLanes = 8;
// Multiply-adds of one dispatch: about 30 ms on two lavapipe threads, so that no dispatch exceeds
// 100 ms.
inline constexpr std::uint64_t kDispatchWork = std::uint64_t(3) << 28;

inline std::uint32_t divideUp(std::uint64_t a, std::uint64_t b)
{
    return std::uint32_t((a + b - 1) / b);
}

// Most of 1..limit that divides `count`: loop turns stay equal, with no remainder to test for.
inline std::uint32_t unroll(std::uint32_t count, std::uint32_t limit)
{
    std::uint32_t best = 1;
    for (std::uint32_t u = 2; u <= limit; ++u)
        if (count % u == 0)
            best = u;
    return best;
}

inline std::uint32_t shuffleFlag(const RenderGraph& graph)
{
    return graph.context().subgroupSize() >= kConvLanes ? gpu::kConvShuffle : 0;
}

} // namespace strandlight
