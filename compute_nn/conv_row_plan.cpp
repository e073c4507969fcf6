#include "compute_nn/conv_row_plan.hpp"

#include <string>

#include "kernels/nn.gen.hpp"

namespace strandlight {

gpu::ConvRowsPush rowPush(const TensorDesc& source, const TensorId& result,
                          const gpu::TensorView& saved, const LayerWeights& weights, float slope)
{
    return {.source = {},
            .result = result.view(),
            .savedOffset = saved.offset,
            .savedImageStride = saved.imageStride,
            .inChannels = source.c,
            .outChannels = result.desc.c,
            .biasOffset = weights.biasOffset,
            .firstGroup = 0,
            .firstStrip = 0,
            .endStrip = 0,
            .slope = slope};
}

std::vector<std::uint32_t> rowConstants(const ConvPass& conv, const RowPlan& plan,
                                        std::uint32_t group, std::uint32_t flags)
{
    return {group,          plan.channels, plan.columns,
            plan.turn,      conv.kernel.h, conv.kernel.w,
            conv.stride.h,  conv.stride.w, conv.padding.h,
            conv.padding.w, plan.phases,   flags | (plan.minimal ? gpu::kConvMinimal : 0)};
}

BufferId packWeights(RenderGraph& graph, PassBuilder& pass, std::string_view name,
                     const ConvPass& conv, const RowPlan& plan, const LayerWeights& weights,
                     BufferId parameters, std::uint32_t outChannels)
{
    const gpu::ConvPackPush push{.texels = plan.groups() * plan.turns * plan.turnTexels(),
                                 .weightOffset = weights.weightOffset,
                                 .weightStrideOut = conv.weightStrideOut,
                                 .weightStrideIn = conv.weightStrideIn,
                                 .outChannels = outChannels,
                                 .laneChannels = plan.channels / plan.lanes,
                                 .channelLanes = plan.lanes,
                                 .turns = plan.turns,
                                 .turnInputs = plan.turn,
                                 .turnTexels = plan.turnTexels(),
                                 .taps = plan.taps,
                                 .phases = plan.phases,
                                 .rowTaps = plan.rowTaps,
                                 .kernelHeight = conv.kernel.h,
                                 .kernelWidth = conv.kernel.w,
                                 .paddingHeight = conv.padding.h,
                                 .minimal = plan.minimal,
                                 .turned = conv.turned};
    const BufferId packed = pass.write(
        graph.createBuffer(std::string(name) + " weights", std::uint64_t(push.texels) * 16));
    pass.dispatch(kernels::conv_pack, {push.texels, 1, 1}, push, {parameters, packed});
    return packed;
}

RowBindings bindRows(RenderGraph& graph, PassBuilder& pass, std::string_view name,
                     const ConvPass& conv, const RowPlan& plan, const TensorId& source,
                     const LayerWeights& weights, const TensorId& result)
{
    const Binding from = source.binding(pass.read(source.buffer));
    const BufferId parameters = pass.read(weights.block);
    const BufferId to = pass.write(result.buffer);
    const ConvEpilogue epilogue = bindEpilogue(graph, pass, name, conv, from, result);
    const BufferId packed =
        packWeights(graph, pass, name, conv, plan, weights, parameters, result.desc.c);
    gpu::ConvRowsPush push =
        rowPush(source.desc, result, epilogue.savedView, weights, epilogue.slope);
    push.source = source.view();
    return {from, packed, result.binding(to), parameters, to, epilogue, push};
}

} // namespace strandlight
