#include "compute_nn/conv_desc.hpp"

#include "engine/base/error.hpp"

namespace strandlight {

namespace {

// 2^24 elements of a weight and 2^15 of a side are far beyond any use and keep every product below
// 2^63.
constexpr std::uint32_t kMaximumSide = 1u << 15;

void refuse(const std::string& what, const std::string& reason)
{
    throw Error(what + ": " + reason);
}

template <class Desc>
void checkCommon(const Desc& desc, const TensorDesc& x, const std::string& what)
{
    for (std::uint32_t value : {desc.in, desc.out, desc.kernel.h, desc.kernel.w, desc.stride.h,
                                desc.stride.w, x.n, x.c, x.h, x.w})
        if (value == 0 || value > kMaximumSide)
            refuse(what, "a size is " + std::to_string(value) + ", not in 1.." +
                             std::to_string(kMaximumSide) + "; input " + shapeText(x));
    for (std::uint32_t value : {desc.padding.h, desc.padding.w})
        if (value > kMaximumSide)
            refuse(what, "padding is " + std::to_string(value));
    if (x.c != desc.in)
        refuse(what, "the input " + shapeText(x) + " has " + std::to_string(x.c) +
                         " channels, the weights have " + std::to_string(desc.in));
}

} // namespace

TensorDesc Conv2dDesc::output(const TensorDesc& x, const std::string& what) const
{
    checkCommon(*this, x, what);
    const auto side = [&](std::uint32_t size, std::uint32_t k, std::uint32_t s, std::uint32_t p) {
        if (size + 2 * p < k)
            refuse(what, "a kernel of " + std::to_string(k) + " does not fit the input " +
                             shapeText(x) + " with padding " + std::to_string(p));
        return (size + 2 * p - k) / s + 1;
    };
    return {x.n, out, side(x.h, kernel.h, stride.h, padding.h),
            side(x.w, kernel.w, stride.w, padding.w)};
}

TensorDesc ConvTranspose2dDesc::output(const TensorDesc& x, const std::string& what) const
{
    checkCommon(*this, x, what);
    if (outputPadding.h >= stride.h || outputPadding.w >= stride.w)
        refuse(what, "the output padding must be smaller than the stride");
    const auto side = [&](std::uint32_t size, std::uint32_t k, std::uint32_t s, std::uint32_t p,
                          std::uint32_t extra) {
        const std::uint64_t full = std::uint64_t(size - 1) * s + k + extra;
        if (full <= 2 * std::uint64_t(p) || full - 2 * p > kMaximumSide)
            refuse(what, "the output of the input " + shapeText(x) + " with padding " +
                             std::to_string(p) + " would have no pixel or too many");
        return std::uint32_t(full - 2 * p);
    };
    return {x.n, out, side(x.h, kernel.h, stride.h, padding.h, outputPadding.h),
            side(x.w, kernel.w, stride.w, padding.w, outputPadding.w)};
}

Conv2dDesc denseDesc(std::uint32_t in, std::uint32_t out)
{
    return {.in = in, .out = out, .kernel = {1, 1}, .stride = {1, 1}, .padding = {0, 0}};
}

} // namespace strandlight
