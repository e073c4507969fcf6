// Plain CPU twins of the networks: one training step each, built from the op twins.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compute_nn/loss_kind.hpp"
#include "compute_nn/network_shapes.hpp"

namespace strandlight::reference {

// What a network did with one batch.
template <class T> struct NetworkResult
{
    std::vector<T> output;
    T loss = T(0);
    std::vector<T> gradient; // [parameters], of the loss
};

// x [N,in,H,W], target [N,out,H,W]; mean squared error. Gradients are set, not accumulated.
template <class T>
NetworkResult<T> unet(const UNetDesc& net, std::span<const T> parameters, const TensorDesc& xDesc,
                      std::span<const T> x, std::span<const T> target);

// image [N,3,S,S] (radiance; the network sees ln(1 + x)); directions [S S,3] unit, weights [S S] or
// empty. output: raw lobes [N,L,7]; the loss compares the mixture [N,3,S S] with the image.
template <class T>
NetworkResult<T> encoder(const EncoderDesc& net, std::span<const T> parameters,
                         std::uint32_t images, std::span<const T> image,
                         std::span<const T> directions, std::span<const T> weights, LossKind kind);

} // namespace strandlight::reference
