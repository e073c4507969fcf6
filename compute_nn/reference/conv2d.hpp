// Plain CPU twins of convolution and transposed convolution, forward and backward. Written for the
// reader: loops, no tricks. Dumoulin and Visin. A guide to convolution arithmetic for deep
// learning. 2016
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "compute_nn/conv_desc.hpp"

namespace strandlight::reference {

// Calls visit(yIndex, xIndex, weightIndex) for every product of  y[n,o,oy,ox] = sum
// weight[o,i,ky,kx] x[n,i,iy,ix]. Forward and both gradients are this one sum, read in three
// directions.
template <class Visit>
void forEachProduct(const Conv2dDesc& d, const TensorDesc& x, const TensorDesc& y, Visit visit)
{
    for (std::uint32_t n = 0; n < y.n; ++n)
        for (std::uint32_t o = 0; o < y.c; ++o)
            for (std::uint32_t oy = 0; oy < y.h; ++oy)
                for (std::uint32_t ox = 0; ox < y.w; ++ox)
                    for (std::uint32_t i = 0; i < x.c; ++i)
                        for (std::uint32_t ky = 0; ky < d.kernel.h; ++ky)
                            for (std::uint32_t kx = 0; kx < d.kernel.w; ++kx) {
                                // Unsigned wrap: a pixel left of or above the image is huge, so one
                                // compare does.
                                const std::uint32_t iy = oy * d.stride.h + ky - d.padding.h;
                                const std::uint32_t ix = ox * d.stride.w + kx - d.padding.w;
                                if (iy >= x.h || ix >= x.w)
                                    continue;
                                visit(((std::size_t(n) * y.c + o) * y.h + oy) * y.w + ox,
                                      ((std::size_t(n) * x.c + i) * x.h + iy) * x.w + ix,
                                      ((std::size_t(o) * x.c + i) * d.kernel.h + ky) * d.kernel.w +
                                          kx);
                            }
}

// Adds (not sets) bias[c] to every pixel of t [N,C,H,W]; an empty bias adds nothing.
template <class T> void addBias(const TensorDesc& desc, std::span<const T> bias, std::span<T> t)
{
    if (bias.empty())
        return;
    for (std::size_t i = 0; i < t.size(); ++i)
        t[i] += bias[i / desc.pixels() % desc.c];
}

// dBias[c] += sum over n,h,w of dY[n,c,h,w]; an empty dBias is skipped.
template <class T>
void addBiasBackward(const TensorDesc& desc, std::span<const T> dY, std::span<T> dBias)
{
    if (dBias.empty())
        return;
    for (std::size_t i = 0; i < dY.size(); ++i)
        dBias[i / desc.pixels() % desc.c] += dY[i];
}

// x [N,I,H,W], weight [O,I,Kh,Kw], bias [O] or empty  ->  y [N,O,Oh,Ow] (overwritten)
template <class T>
void conv2d(const Conv2dDesc& d, const TensorDesc& xDesc, std::span<const T> x,
            std::span<const T> weight, std::span<const T> bias, std::span<T> y)
{
    const TensorDesc yDesc = d.output(xDesc);
    std::fill(y.begin(), y.end(), T(0));
    addBias<T>(yDesc, bias, y);
    forEachProduct(d, xDesc, yDesc, [&](std::size_t yi, std::size_t xi, std::size_t wi) {
        y[yi] += weight[wi] * x[xi];
    });
}

// dY [N,O,Oh,Ow]  ->  accumulates into dX [N,I,H,W], dWeight [O,I,Kh,Kw], dBias [O]. Empty spans
// are skipped. Saved: x (for dWeight) and weight (for dX).
template <class T>
void conv2dBackward(const Conv2dDesc& d, const TensorDesc& xDesc, std::span<const T> x,
                    std::span<const T> weight, std::span<const T> dY, std::span<T> dX,
                    std::span<T> dWeight, std::span<T> dBias)
{
    const TensorDesc yDesc = d.output(xDesc);
    addBiasBackward<T>(yDesc, dY, dBias);
    forEachProduct(d, xDesc, yDesc, [&](std::size_t yi, std::size_t xi, std::size_t wi) {
        if (!dX.empty())
            dX[xi] += weight[wi] * dY[yi];
        if (!dWeight.empty())
            dWeight[wi] += x[xi] * dY[yi];
    });
}

// The conv2d whose data gradient is `d`: it maps y [N,O,Oh,Ow] back to x [N,I,H,W] with weight
// [I,O,Kh,Kw].
inline Conv2dDesc adjoint(const ConvTranspose2dDesc& d)
{
    return {.in = d.out, .out = d.in, .kernel = d.kernel, .stride = d.stride, .padding = d.padding};
}

// x [N,I,H,W], weight [I,O,Kh,Kw], bias [O] or empty  ->  y [N,O,Oh,Ow] (overwritten)
template <class T>
void convTranspose2d(const ConvTranspose2dDesc& d, const TensorDesc& xDesc, std::span<const T> x,
                     std::span<const T> weight, std::span<const T> bias, std::span<T> y)
{
    const TensorDesc yDesc = d.output(xDesc);
    std::fill(y.begin(), y.end(), T(0));
    addBias<T>(yDesc, bias, y);
    forEachProduct(adjoint(d), yDesc, xDesc, [&](std::size_t xi, std::size_t yi, std::size_t wi) {
        y[yi] += weight[wi] * x[xi];
    });
}

// dY [N,O,Oh,Ow]  ->  accumulates into dX [N,I,H,W], dWeight [I,O,Kh,Kw], dBias [O]. Empty spans
// are skipped.
template <class T>
void convTranspose2dBackward(const ConvTranspose2dDesc& d, const TensorDesc& xDesc,
                             std::span<const T> x, std::span<const T> weight, std::span<const T> dY,
                             std::span<T> dX, std::span<T> dWeight, std::span<T> dBias)
{
    const TensorDesc yDesc = d.output(xDesc);
    addBiasBackward<T>(yDesc, dY, dBias);
    forEachProduct(adjoint(d), yDesc, xDesc, [&](std::size_t xi, std::size_t yi, std::size_t wi) {
        if (!dX.empty())
            dX[xi] += weight[wi] * dY[yi];
        if (!dWeight.empty())
            dWeight[wi] += x[xi] * dY[yi];
    });
}

// x [N,I], weight [O,I], bias [O] or empty  ->  y [N,O]
template <class T>
void dense(std::uint32_t images, std::uint32_t in, std::uint32_t out, std::span<const T> x,
           std::span<const T> weight, std::span<const T> bias, std::span<T> y)
{
    conv2d<T>(denseDesc(in, out), {images, in, 1, 1}, x, weight, bias, y);
}

// dY [N,O]  ->  accumulates into dX [N,I], dWeight [O,I], dBias [O]
template <class T>
void denseBackward(std::uint32_t images, std::uint32_t in, std::uint32_t out, std::span<const T> x,
                   std::span<const T> weight, std::span<const T> dY, std::span<T> dX,
                   std::span<T> dWeight, std::span<T> dBias)
{
    conv2dBackward<T>(denseDesc(in, out), {images, in, 1, 1}, x, weight, dY, dX, dWeight, dBias);
}

} // namespace strandlight::reference
