// What a convolution is; refuses nonsense and tells the shape of the output.
// Dumoulin and Visin. A guide to convolution arithmetic for deep learning. 2016
#pragma once

#include <cstdint>
#include <string>

#include "compute_nn/tensor_desc.hpp"

namespace strandlight {

struct Extent2
{
    std::uint32_t h = 1;
    std::uint32_t w = 1;
    friend bool operator==(const Extent2&, const Extent2&) = default;
};

// y[n,o,oy,ox] = bias[o] + sum over i,ky,kx of weight[o,i,ky,kx] x[n,i, oy sh - ph + ky, ox sw - pw
// + kx]
struct Conv2dDesc
{
    std::uint32_t in = 1;
    std::uint32_t out = 1;
    Extent2 kernel = {3, 3};
    Extent2 stride = {1, 1};
    Extent2 padding = {1, 1};

    std::uint64_t weightElements() const // [O,I,Kh,Kw]
    {
        return std::uint64_t(out) * in * kernel.h * kernel.w;
    }
    // Throws Error naming `what` and both shapes when `x` does not fit.
    TensorDesc output(const TensorDesc& x, const std::string& what = "conv2d") const;
};

// The transpose of the map above: every input pixel (iy,ix) adds weight[i,o,ky,kx] x[n,i,iy,ix] to
// the output pixel (iy sh - ph + ky, ix sw - pw + kx).
struct ConvTranspose2dDesc
{
    std::uint32_t in = 1;
    std::uint32_t out = 1;
    Extent2 kernel = {2, 2};
    Extent2 stride = {2, 2};
    Extent2 padding = {0, 0};
    Extent2 outputPadding = {0, 0}; // rows and columns that a strided conv2d would have dropped

    std::uint64_t weightElements() const // [I,O,Kh,Kw]
    {
        return std::uint64_t(in) * out * kernel.h * kernel.w;
    }
    TensorDesc output(const TensorDesc& x, const std::string& what = "conv_transpose2d") const;
};

// A dense layer is a convolution of one pixel by a 1x1 kernel: x [N,I,1,1], weight [O,I], y
// [N,O,1,1].
Conv2dDesc denseDesc(std::uint32_t in, std::uint32_t out);

} // namespace strandlight
