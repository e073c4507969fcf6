#include "compute_nn/conv_row_plan.hpp"

#include <string>

#include "kernels/nn.gen.hpp"

namespace strandlight {

BufferId packWeights(RenderGraph& graph, PassBuilder& pass, std::string_view name,
                     const ConvPass& conv, const RowPlan& plan, const LayerWeights& weights,
                     BufferId parameters, std::uint32_t outChannels)
{
    const gpu::ConvPackPush push{.texels = plan.groups() * plan.turns * plan.turnTexels(),
                                 .weightOffset = weights.weightOffset,
                                 .weightStrideOut = conv.weightStrideOut,
                                 .weightStrideIn = conv.weightStrideIn,
                                 .outChannels = outChannels,
                                 .channels = plan.channels,
                                 .turns = plan.turns,
                                 .turnInputs = plan.turn,
                                 .turnTexels = plan.turnTexels(),
                                 .taps = plan.taps,
                                 .phases = plan.phases,
                                 .kernelWidth = conv.kernel.w,
                                 .paddingHeight = conv.padding.h};
    const BufferId packed = pass.write(
        graph.createBuffer(std::string(name) + " weights", std::uint64_t(push.texels) * 16));
    pass.dispatch(kernels::conv_pack, {push.texels, 1, 1}, push, {parameters, packed});
    return packed;
}

} // namespace strandlight
