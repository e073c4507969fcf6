// The light-field encoder: a radiance image per texel in, N spherical gaussians out.
// Currius, Dolonius, Assarsson, Sintorn. Spherical Gaussian Light-field Textures for Fast
// Precomputed GI. 2020
#pragma once

#include <array>
#include <optional>

#include "compute_nn/adam_settings.hpp"
#include "compute_nn/loss.hpp"
#include "compute_nn/network_shapes.hpp"
#include "compute_nn/parameters.hpp"

namespace strandlight {

// What the forward pass leaves for the backward pass.
struct EncoderValues
{
    std::array<TensorId, 5> features; // ln(1 + image), then the four activated convolutions
    TensorId raw;                     // [N, 7 lobes, 1, 1]
};

// image [N,3,S,S] (radiance) -> raw lobes.
EncoderValues encoderForward(RenderGraph& graph, const EncoderDesc& net,
                             const ParameterIds& parameters, const TensorId& image);

// dRaw [N, 7 lobes, 1, 1] -> accumulates into the parameters' gradients.
void encoderBackward(RenderGraph& graph, const EncoderDesc& net, ParameterIds& parameters,
                     const EncoderValues& values, const TensorId& dRaw);

struct EncoderTraining
{
    LossKind loss = LossKind::Log1p;
    AdamSettings adam;
    std::optional<LossWeights> weights; // per direction: count S S, stride 1
};

struct EncoderStep
{
    BufferId loss;     // [1]
    TensorId raw;      // as before the step
    TensorId radiance; // [N,3,S,S], the mixture in every direction
};

// One step: encode, mix, compare with the image, back, check, Adam. directions [S S, 3], unit, in
// the image's order.
EncoderStep addEncoderTrainingStep(RenderGraph& graph, const EncoderDesc& net,
                                   ParameterIds& parameters, const TensorId& image,
                                   BufferId directions, const EncoderTraining& training,
                                   std::uint32_t step);

} // namespace strandlight
