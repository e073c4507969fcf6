// One step of the filter network's training, and its loss, as passes of a graph.
#pragma once

#include "compute_nn/adam_settings.hpp"
#include "compute_nn/network_shapes.hpp"
#include "compute_nn/parameters.hpp"
#include "passes/hair_training_batch.hpp"

namespace strandlight {

// Weights of the loss's mean squares. The picture is B c / luminance(c) + T behind: brightness and
// transmittance weigh as they show; the colour only turns brightness into three channels; the
// illumination is not shown and guides the layers below.
struct HairLossWeights
{
    float brightness = 1.0f; // of ln(1 + B), so that a highlight does not outweigh a picture
    float illumination = 0.1f;
    float transmittance = 0.5f;
    float color = 0.5f; // of ln(1 + kernel-filtered radiance), mean of the channels
};

struct HairLossIds
{
    BufferId outputs; // [1] brightness, illumination and transmittance, weighted
    BufferId color;   // [1] weighted
    double value(const RenderGraph& graph) const; // after execute()
};

// Forward pass and loss alone, for held-out frames; `y` [n,12,size,size].
struct HairEvaluation
{
    TensorId y;        // [n,12,size,size]
    TensorId filtered; // [n,4,size,size] radiance under the predicted kernels
    HairLossIds loss;
};
HairEvaluation addHairEvaluation(RenderGraph& graph, const UNetDesc& net, ParameterIds& parameters,
                                 const HairBatch& batch, const HairLossWeights& weights = {});

// Forward, loss, backward, checks, Adam's step `step` (from 1).
HairLossIds addHairTrainingStep(RenderGraph& graph, const UNetDesc& net, ParameterIds& parameters,
                                const HairBatch& batch, const AdamSettings& adam,
                                std::uint32_t step, const HairLossWeights& weights = {});

} // namespace strandlight
