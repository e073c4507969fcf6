#include "samples/strandlight/bench_conv_twin.hpp"

namespace strandlight::cli {

namespace {

// Where an element lies in a tensor [N,C,H,W] or a weight [A,B,Kh,Kw].
struct Place
{
    std::uint32_t n, c, y, x;
};
Place placeOf(std::uint64_t index, std::uint32_t c, std::uint32_t h, std::uint32_t w)
{
    return {std::uint32_t(index / w / h / c), std::uint32_t(index / w / h % c),
            std::uint32_t(index / w % h), std::uint32_t(index % w)};
}

float at(const TensorDesc& d, std::span<const float> values, std::uint32_t n, std::uint32_t c,
         std::uint32_t y, std::uint32_t x)
{
    return values[((std::uint64_t(n) * d.c + c) * d.h + y) * d.w + x];
}

// sum over n,y,x of small[n,a,y,x] large[n,b, y sh - ph + ky, x sw - pw + kx]; both weight
// gradients.
template <class Desc>
double correlation(const Desc& d, const Place& weight, const TensorDesc& smallDesc,
                   std::span<const float> small, const TensorDesc& largeDesc,
                   std::span<const float> large)
{
    double sum = 0.0;
    for (std::uint32_t n = 0; n < smallDesc.n; ++n)
        for (std::uint32_t y = 0; y < smallDesc.h; ++y)
            for (std::uint32_t x = 0; x < smallDesc.w; ++x) {
                const std::uint32_t ly = y * d.stride.h + weight.y - d.padding.h; // wraps: refused
                const std::uint32_t lx = x * d.stride.w + weight.x - d.padding.w;
                if (ly < largeDesc.h && lx < largeDesc.w)
                    sum += double(at(smallDesc, small, n, weight.n, y, x)) *
                           at(largeDesc, large, n, weight.c, ly, lx);
            }
    return sum;
}

} // namespace

double convFlops(const Conv2dDesc& desc, const TensorDesc& x)
{
    return 2.0 * double(desc.weightElements()) * desc.output(x).n * desc.output(x).pixels();
}

double convFlops(const ConvTranspose2dDesc& desc, const TensorDesc& x)
{
    return 2.0 * double(desc.weightElements()) * x.n * x.pixels();
}

double ConvTwin::output(const Conv2dDesc& d, std::uint64_t index) const
{
    const Place p = placeOf(index, yDesc.c, yDesc.h, yDesc.w);
    double sum = bias[p.c];
    for (std::uint32_t i = 0; i < d.in; ++i)
        for (std::uint32_t ky = 0; ky < d.kernel.h; ++ky)
            for (std::uint32_t kx = 0; kx < d.kernel.w; ++kx) {
                const std::uint32_t y = p.y * d.stride.h + ky - d.padding.h;
                const std::uint32_t x0 = p.x * d.stride.w + kx - d.padding.w;
                if (y < xDesc.h && x0 < xDesc.w)
                    sum +=
                        double(at({d.out, d.in, d.kernel.h, d.kernel.w}, weights, p.c, i, ky, kx)) *
                        at(xDesc, x, p.n, i, y, x0);
            }
    return sum;
}

double ConvTwin::output(const ConvTranspose2dDesc& d, std::uint64_t index) const
{
    const Place p = placeOf(index, yDesc.c, yDesc.h, yDesc.w);
    double sum = bias[p.c];
    for (std::uint32_t i = 0; i < d.in; ++i)
        for (std::uint32_t ky = 0; ky < d.kernel.h; ++ky)
            for (std::uint32_t kx = 0; kx < d.kernel.w; ++kx) {
                const std::uint32_t y = p.y + d.padding.h - ky; // of the stretched input
                const std::uint32_t x0 = p.x + d.padding.w - kx;
                if (y % d.stride.h == 0 && x0 % d.stride.w == 0 && y / d.stride.h < xDesc.h &&
                    x0 / d.stride.w < xDesc.w)
                    sum +=
                        double(at({d.in, d.out, d.kernel.h, d.kernel.w}, weights, i, p.c, ky, kx)) *
                        at(xDesc, x, p.n, i, y / d.stride.h, x0 / d.stride.w);
            }
    return sum;
}

double ConvTwin::weightGradient(const Conv2dDesc& d, std::uint64_t index,
                                std::span<const float> dY) const
{
    return correlation(d, placeOf(index, d.in, d.kernel.h, d.kernel.w), yDesc, dY, xDesc, x);
}

double ConvTwin::weightGradient(const ConvTranspose2dDesc& d, std::uint64_t index,
                                std::span<const float> dY) const
{
    return correlation(d, placeOf(index, d.out, d.kernel.h, d.kernel.w), xDesc, x, yDesc, dY);
}

} // namespace strandlight::cli
