#include "passes/hair_train_step.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "compute_nn/adam.hpp"
#include "compute_nn/kernel_filter.hpp"
#include "compute_nn/loss.hpp"
#include "compute_nn/unet.hpp"
#include "shaders/shared/hair_types.h"

namespace strandlight {
namespace {

struct Forward
{
    TensorId target; // [n,12,..]
    TensorId image;  // [n,4,..]
    UNetValues values;
    TensorId filtered; // [n,4,..]
    LossResult outputs, color;

    HairLossIds ids() const { return {outputs.value, color.value}; }
    TensorId logits() const { return channelRange(values.y, 3, 9); }
};

LossWeights uploadWeights(RenderGraph& graph, std::string_view name, std::span<const float> each,
                          std::uint32_t pixels)
{
    return {graph.uploadBuffer(name, each), std::uint32_t(each.size()), pixels};
}

// The network without a head reads its input from level 0, [up, skip], in place.
TensorId uploadInput(RenderGraph& graph, const UNetDesc& net, const HairBatch& batch)
{
    if (net.head > 0)
        return uploadTensor(graph, "hair planes", {batch.n, net.in, batch.size, batch.size},
                            batch.input);
    const std::size_t pixels = std::size_t(batch.size) * batch.size;
    const std::size_t planes = net.channels(0), up = net.upChannels(0);
    std::vector<float> level(batch.n * planes * pixels);
    for (std::size_t n = 0; n < batch.n; ++n)
        std::copy_n(batch.input.begin() + std::ptrdiff_t(n * net.in * pixels), net.in * pixels,
                    level.begin() + std::ptrdiff_t((n * planes + up) * pixels));
    return {graph.uploadBuffer("hair planes", std::span<const float>(level)),
            {batch.n, net.in, batch.size, batch.size},
            std::uint32_t(up),
            std::uint32_t(planes)};
}

Forward addForward(RenderGraph& graph, const UNetDesc& net, ParameterIds& parameters,
                   const HairBatch& batch, const HairLossWeights& w)
{
    const auto upload = [&](const char* name, std::uint32_t planes,
                            const std::vector<float>& data) {
        return uploadTensor(graph, name, {batch.n, planes, batch.size, batch.size}, data);
    };
    Forward f;
    const TensorId x = uploadInput(graph, net, batch);
    f.target = upload("hair target", kHairOutputs, batch.target);
    f.image = upload("hair radiance", 4, batch.image);
    const TensorId truth = upload("hair truth", 4, batch.truth);
    parameters.checkFinite(graph, "input", x.buffer, 0,
                           std::uint32_t(graph.desc(x.buffer).bytes / sizeof(float)),
                           std::numeric_limits<float>::max());
    parameters.checkFinite(graph, "target", f.target);
    f.values = unetForward(graph, net, parameters, x);
    f.filtered = kernelFilterForward(graph, "hair color", f.logits(), f.image,
                                     createTensor(graph, "filtered radiance", f.image.desc));
    // The loss pass takes the mean over all channels: the logits have no target of their own.
    std::array<float, kHairOutputs> outputs{};
    outputs[0] = float(kHairOutputs) * w.brightness;
    outputs[1] = float(kHairOutputs) * w.illumination;
    outputs[2] = float(kHairOutputs) * w.transmittance;
    const float channel = 4.0f / 3.0f * w.color;
    const std::array<float, 4> color = {channel, channel, channel, 0.0f};
    const std::uint32_t pixels = batch.size * batch.size;
    f.outputs = addLossPass(graph, "hair loss", LossKind::MeanSquare, f.values.y, f.target,
                            uploadWeights(graph, "hair loss weights", outputs, pixels));
    f.color = addLossPass(graph, "hair color loss", LossKind::Log1p, f.filtered, truth,
                          uploadWeights(graph, "hair color weights", color, pixels));
    return f;
}

} // namespace

double HairLossIds::value(const RenderGraph& graph) const
{
    return double(graph.read<float>(outputs).front()) + double(graph.read<float>(color).front());
}

HairEvaluation addHairEvaluation(RenderGraph& graph, const UNetDesc& net, ParameterIds& parameters,
                                 const HairBatch& batch, const HairLossWeights& weights)
{
    parameters.clearGradients(graph);
    const Forward f = addForward(graph, net, parameters, batch, weights);
    for (const BufferId id : {f.values.y.buffer, f.filtered.buffer, f.outputs.value, f.color.value})
        graph.output(id);
    return {f.values.y, f.filtered, f.ids()};
}

HairLossIds addHairTrainingStep(RenderGraph& graph, const UNetDesc& net, ParameterIds& parameters,
                                const HairBatch& batch, const AdamSettings& adam,
                                std::uint32_t step, const HairLossWeights& weights)
{
    parameters.clearGradients(graph);
    const Forward f = addForward(graph, net, parameters, batch, weights);
    // The colour's gradient goes where the logits' part of the first loss left zeros.
    const TensorId dLogits =
        kernelFilterBackward(graph, "hair color dLogits", f.logits(), f.image, f.color.gradient,
                             channelRange(f.outputs.gradient, 3, 9));
    unetBackward(graph, net, parameters, f.values, f.outputs.gradient.as(dLogits.buffer));
    addAdamPass(graph, parameters, adam, step);
    graph.output(f.outputs.value);
    graph.output(f.color.value);
    return f.ids();
}

} // namespace strandlight
