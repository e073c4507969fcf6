// How convolution passes cut their work and bind what comes after the sum; for the files of such
// kernels.
#pragma once

#include <cstdint>

#include "compute_nn/conv_passes.hpp"
#include "compute_nn/half_guard.hpp"
#include "engine/base/assert.hpp"
#include "engine/graph/render_graph.hpp"
#include "shaders/shared/nn_types.h"

namespace strandlight {

// Lanes that share a load in every convolution kernel.
inline constexpr std::uint32_t kConvLanes = 8;
// Multiply-adds of one dispatch: about 30 ms on two lavapipe threads, so that no dispatch exceeds
// 100 ms.
inline constexpr std::uint64_t kDispatchWork = std::uint64_t(3) << 28;

inline constexpr std::uint32_t kMaxGroups = 65535u; // of any device, per axis

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

// Whether rows are whole texels of four floats.
inline bool wholeQuads(const TensorId& tensor)
{
    const gpu::TensorView view = tensor.view();
    return view.offset % 4 == 0 && view.imageStride % 4 == 0 && view.width % 4 == 0;
}

inline std::uint32_t shuffleFlag(const RenderGraph& graph)
{
    return graph.context().subgroupSize() >= kConvLanes ? gpu::kConvShuffle : 0;
}

// What a convolution kernel does besides the sum, as it binds and specialises it.
struct ConvEpilogue
{
    Binding saved; // the activated values; without them the source, which nothing reads
    gpu::TensorView savedView{};
    Binding guard; // of a result of halves; without one the source
    std::uint32_t flags = 0;
    float slope = 1.0f;
};

// The variant of a kernel that loads and stores these tensors' elements.
inline const KernelBlob& variantFor(const TensorId& source, const TensorId& result,
                                    const KernelBlob& floats, const KernelBlob& halves,
                                    const KernelBlob& fromHalves)
{
    if (source.element == Element::Float) {
        STRANDLIGHT_ASSERT(result.element == Element::Float);
        return floats;
    }
    return result.element == Element::Half ? halves : fromHalves;
}

inline ConvEpilogue bindEpilogue(const RenderGraph& graph, PassBuilder& pass, std::string_view name,
                                 const ConvPass& conv, const Binding& source,
                                 const TensorId& result)
{
    const BackwardEpilogue& backward = conv.backward;
    ConvEpilogue epilogue{.saved = source, .guard = source, .slope = conv.slope};
    if (result.element == Element::Half) {
        STRANDLIGHT_ASSERT(conv.guard);
        epilogue.guard = conv.guard->bind(pass, name);
    }
    epilogue.flags = (conv.bias ? gpu::kConvBias : 0) |
                     (backward.accumulate ? gpu::kConvAccumulate : 0) | shuffleFlag(graph);
    if (backward.activated) {
        epilogue.saved = backward.activated->binding(pass.read(backward.activated->buffer));
        epilogue.savedView = backward.activated->view();
        epilogue.flags |= gpu::kConvDerivative;
        epilogue.slope = backward.slope;
    }
    return epilogue;
}

} // namespace strandlight
