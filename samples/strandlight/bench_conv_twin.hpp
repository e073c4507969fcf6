// Single outputs of convolutions in double: compute_nn/reference/conv2d.hpp for one element at a
// time. Dumoulin and Visin. A guide to convolution arithmetic for deep learning. 2016
#pragma once

#include <cstdint>
#include <span>

#include "compute_nn/conv_desc.hpp"

namespace strandlight::cli {

// Multiply-adds of the whole map count as two.
double convFlops(const Conv2dDesc& desc, const TensorDesc& x);
double convFlops(const ConvTranspose2dDesc& desc, const TensorDesc& x);

struct ConvTwin
{
    TensorDesc xDesc, yDesc;
    std::span<const float> x, weights, bias; // as the descriptions say

    // y[index] before the activation.
    double output(const Conv2dDesc& desc, std::uint64_t index) const;
    double output(const ConvTranspose2dDesc& desc, std::uint64_t index) const;
    // d loss / d weights[index] when d loss / d y is dY.
    double weightGradient(const Conv2dDesc& desc, std::uint64_t index,
                          std::span<const float> dY) const;
    double weightGradient(const ConvTranspose2dDesc& desc, std::uint64_t index,
                          std::span<const float> dY) const;
};

} // namespace strandlight::cli
