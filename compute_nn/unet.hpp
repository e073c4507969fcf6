// The U-Net filter: twenty-four planes in, three out.
// Ronneberger, Fischer, Brox. U-Net. 2015
// Currius, Assarsson, Sintorn. Real-Time Hair Filtering with Convolutional Neural Networks. 2022
#pragma once

#include "compute_nn/adam_settings.hpp"
#include "compute_nn/loss.hpp"
#include "compute_nn/network_shapes.hpp"
#include "compute_nn/parameters.hpp"

namespace strandlight {

// What the forward pass leaves for the backward pass. Skip connections are channel ranges: [up,
// skip] in one buffer.
struct UNetValues
{
    TensorId x;    // [N,24,H,W]
    TensorId cat0; // [N,16+16,H,W]: dec0, enc0
    TensorId cat1; // [N,32+32,H/2,W/2]: dec1, enc1
    TensorId enc2; // [N,48,H/4,W/4]
    TensorId y;    // [N,3,H,W]
};

// x [N,24,H,W], H and W multiples of 4 -> y [N,3,H,W]. Throws Error for other shapes.
UNetValues unetForward(RenderGraph& graph, const UNetDesc& net, const ParameterIds& parameters,
                       const TensorId& x);

// dY [N,3,H,W] -> accumulates into the parameters' gradients.
void unetBackward(RenderGraph& graph, const UNetDesc& net, ParameterIds& parameters,
                  const UNetValues& values, const TensorId& dY);

struct UNetStep
{
    BufferId loss; // [1]
    TensorId y;
};

// One step: forward, mean squared error, backward, check, Adam.
UNetStep addUNetTrainingStep(RenderGraph& graph, const UNetDesc& net, ParameterIds& parameters,
                             const TensorId& x, const TensorId& target, const AdamSettings& adam,
                             std::uint32_t step);

} // namespace strandlight
