// The U-Net filter: planes of an image in, planes out, any number of levels.
// Ronneberger, Fischer, Brox. U-Net. 2015
// Currius, Assarsson, Sintorn. Real-Time Hair Filtering with Convolutional Neural Networks. 2022
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "compute_nn/adam_settings.hpp"
#include "compute_nn/half_guard.hpp"
#include "compute_nn/loss.hpp"
#include "compute_nn/network_shapes.hpp"
#include "compute_nn/parameters.hpp"
#include "compute_nn/unet_tiles.hpp"

namespace strandlight {

// What the forward pass leaves for the backward pass. Skip connections are channel ranges of one
// buffer a level, so concatenation copies nothing.
struct UNetValues
{
    TensorId x;                   // [N,in,H,W], as it was given
    std::vector<TensorId> levels; // [N,up+skip,H/2^l,W/2^l]
    TensorId y;                   // [N,out,H,W]
};

// Where a pass writes the network's input [N,in,H,W]. Of a network without a head it is a range of
// level 0: the input needs no copy to be concatenated. Throws Error for shapes that do not fit.
TensorId createUNetInput(RenderGraph& graph, const UNetDesc& net, const TensorDesc& x,
                         Element element = Element::Float);

// x [N,in,H,W] -> y [N,out,H,W]. Any tensor may be x; without a head, one that createUNetInput did
// not make is copied once. With tiles (N = 1, x from createUNetInput) every layer computes these
// alone, and what they do not reach of y is undefined. With a guard, x and the levels are stored as
// halves (an x of floats is copied) and y as floats; then there is no backward pass. Throws Error
// for shapes that do not fit.
UNetValues unetForward(RenderGraph& graph, const UNetDesc& net, const ParameterIds& parameters,
                       const TensorId& x, const UNetTiles* tiles = nullptr,
                       HalfGuard* halves = nullptr);

// An input that no tensor holds: the layers that read it fetch it themselves.
struct UNetFetch
{
    TensorDesc x; // [1,in,H,W]
    // addConvPass with x as its source. `continued`: sums begin with what y [1,O,Oh,Ow] holds.
    std::function<TensorId(std::string_view name, const ConvPass& conv, bool continued,
                           const LayerWeights& weights, const TensorId& y)>
        convolve;
};

// x -> y [1,out,H,W] with the bits of a tensor of floats as x. The rest as above.
TensorId unetForward(RenderGraph& graph, const UNetDesc& net, const ParameterIds& parameters,
                     const UNetFetch& x, const UNetTiles* tiles = nullptr,
                     HalfGuard* halves = nullptr);

// dY [N,out,H,W] -> accumulates into the parameters' gradients. x gets none.
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
