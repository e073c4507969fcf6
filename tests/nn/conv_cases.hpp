// Random and awkward convolution shapes, shared by the tests of the twins and of the kernels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "compute_nn/conv_desc.hpp"
#include "shaders/shared/rng.h"

namespace strandlight::test {

struct ConvCase
{
    TensorDesc x;
    Conv2dDesc conv;
    ConvTranspose2dDesc transpose; // the same numbers, with an output padding
};

inline ConvCase makeConvCase(TensorDesc x, std::uint32_t out, Extent2 kernel, Extent2 stride,
                             Extent2 padding, Extent2 outputPadding)
{
    return {x,
            {.in = x.c, .out = out, .kernel = kernel, .stride = stride, .padding = padding},
            {.in = x.c,
             .out = out,
             .kernel = kernel,
             .stride = stride,
             .padding = padding,
             .outputPadding = outputPadding}};
}

// The corners that break index arithmetic.
inline std::vector<ConvCase> awkwardConvCases()
{
    return {
        makeConvCase({1, 1, 1, 1}, 1, {1, 1}, {1, 1}, {0, 0}, {0, 0}),
        makeConvCase({2, 33, 1, 1}, 5, {1, 1}, {1, 1}, {0, 0}, {0, 0}), // dense
        makeConvCase({1, 3, 1, 1}, 33, {3, 3}, {1, 1}, {1, 1}, {0, 0}), // all taps but one outside
        makeConvCase({3, 7, 7, 13}, 5, {5, 5}, {2, 2}, {2, 2}, {1, 1}), // primes
        makeConvCase({1, 2, 11, 5}, 17, {3, 2}, {3, 2}, {1, 1},
                     {2, 1}), // kernel and stride differ by side
        makeConvCase({1, 1, 4, 4}, 16, {2, 2}, {3, 3}, {0, 0},
                     {2, 2}), // stride beyond the kernel: holes
        makeConvCase({2, 5, 6, 4}, 3, {4, 4}, {2, 2}, {3, 3}, {0, 0}), // padding of kernel - 1
    };
}

// Rows of whole quads on both sides: the weight gradient's form for CPU devices. Widths around its
// turns of eight pixels, channels around its vectors.
inline std::vector<ConvCase> quadConvCases()
{
    return {
        makeConvCase({2, 7, 5, 12}, 33, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
        makeConvCase({3, 5, 6, 8}, 3, {3, 3}, {2, 2}, {1, 1}, {1, 1}),
        makeConvCase({1, 3, 10, 24}, 17, {4, 4}, {2, 2}, {1, 1}, {0, 0}),
        makeConvCase({1, 17, 4, 40}, 9, {2, 2}, {2, 2}, {0, 0}, {0, 0}),
        makeConvCase({2, 33, 3, 4}, 1, {1, 1}, {1, 1}, {0, 0}, {0, 0}),
        makeConvCase({1, 1, 7, 16}, 5, {3, 5}, {2, 1}, {0, 2}, {1, 0}),
    };
}

// Layers whose lanes are output channels on CPU devices (compute_nn/conv_channels.hpp), and weight
// gradients at points: channels around the vectors of eight, rows around the tiles, few channels on
// either side.
inline std::vector<ConvCase> channelConvCases()
{
    return {
        makeConvCase({1, 5, 6, 16}, 16, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
        makeConvCase({2, 3, 11, 24}, 24, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
        makeConvCase({1, 8, 12, 40}, 7, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
        makeConvCase({1, 14, 14, 12}, 29, {3, 3}, {1, 1}, {0, 2}, {0, 0}), // to 12x14 and 16x10
        makeConvCase({3, 33, 5, 8}, 2, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
        makeConvCase({1, 16, 6, 8}, 5, {3, 3}, {1, 1}, {3, 3}, {0, 0}), // padding covers the kernel
        makeConvCase({3, 9, 11, 160}, 8, {3, 3}, {1, 1}, {1, 1},
                     {0, 0}), // strips end inside images
        makeConvCase({1, 3, 12, 32}, 16, {4, 4}, {2, 2}, {1, 1}, {0, 0}),
        makeConvCase({2, 7, 10, 16}, 31, {4, 4}, {2, 2}, {1, 1}, {0, 0}),
    };
}

// The shapes that have sliding-window kernels (compute_nn/conv_tiles.cpp), at widths around their
// tiles.
inline std::vector<ConvCase> rowConvCases()
{
    return {
        makeConvCase({2, 24, 7, 41}, 33, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
        makeConvCase({1, 33, 5, 16}, 3, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
        makeConvCase({1, 1, 3, 1}, 1, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
        makeConvCase({1, 2, 9, 23}, 17, {3, 3}, {1, 1}, {0, 2}, {0, 0}), // other paddings
        makeConvCase({1, 3, 11, 79}, 24, {3, 3}, {2, 2}, {1, 1}, {1, 0}),
        makeConvCase({2, 5, 6, 37}, 16, {3, 3}, {2, 2}, {1, 1}, {1, 1}),
        makeConvCase({1, 7, 8, 82}, 16, {4, 4}, {2, 2}, {1, 1}, {0, 0}),
        makeConvCase({2, 3, 7, 33}, 5, {4, 4}, {2, 2}, {1, 1}, {0, 1}),
        makeConvCase({1, 9, 10, 43}, 24, {2, 2}, {2, 2}, {0, 0}, {1, 1}),
        makeConvCase({1, 24, 3, 47}, 10, {1, 1}, {1, 1}, {0, 0}, {0, 0}),
        // Whole quads, the last strip cut.
        makeConvCase({2, 9, 5, 20}, 17, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
        makeConvCase({2, 6, 9, 40}, 18, {3, 3}, {2, 2}, {1, 1}, {1, 1}),
        makeConvCase({1, 10, 8, 56}, 19, {4, 4}, {2, 2}, {1, 1}, {0, 0}),
        makeConvCase({2, 12, 6, 24}, 20, {2, 2}, {2, 2}, {0, 0}, {0, 0}),
        makeConvCase({1, 12, 5, 20}, 21, {1, 1}, {1, 1}, {0, 0}, {0, 0}),
    };
}

// One of `options`, or a number in [low, high], by counter: the same on every machine.
class ConvCaseDice
{
public:
    explicit ConvCaseDice(std::uint32_t index) : index_(index) {}
    std::uint32_t pick(std::uint32_t low, std::uint32_t high)
    {
        const float u = gpu::uniform3(index_, 0, dimension_++, 7).x;
        return low + std::uint32_t(u * float(high - low + 1));
    }
    std::uint32_t of(std::initializer_list<std::uint32_t> options)
    {
        return options.begin()[pick(0, std::uint32_t(options.size()) - 1)];
    }

private:
    std::uint32_t index_, dimension_ = 0;
};

// Any kernel up to 5x5, stride up to 3 and padding up to the kernel: ones, primes, odd and even
// numbers, 1 to 33 channels.
inline ConvCase anyConvCase(std::uint32_t index)
{
    ConvCaseDice dice(index);
    const auto channels = [&] {
        return dice.of({1, 2, 3, 4, 5, 7, 8, 11, 13, 16, 17, 24, 31, 33});
    };
    const Extent2 kernel = {dice.pick(1, 5), dice.pick(1, 5)};
    const Extent2 stride = {dice.pick(1, 3), dice.pick(1, 3)};
    const Extent2 padding = {dice.pick(0, kernel.h), dice.pick(0, kernel.w)};
    const Extent2 extra = {dice.pick(0, stride.h - 1), dice.pick(0, stride.w - 1)};
    // No width of whole quads: those have a kernel of their own, compiled for each shape of window.
    TensorDesc x = {dice.pick(1, 3), channels(), dice.of({1, 2, 3, 4, 5, 7, 8, 11, 13}),
                    dice.of({1, 2, 3, 5, 7, 10, 11, 13})};
    x.h = std::max(x.h, kernel.h - std::min(kernel.h - 1, 2 * padding.h));
    x.w = std::max(x.w, kernel.w - std::min(kernel.w - 1, 2 * padding.w));
    x.w += x.w % 4 == 0 ? 1 : 0;
    ConvCase c = makeConvCase(x, channels(), kernel, stride, padding, extra);
    // The transposed layer loses its output to a large padding: as much of it as leaves a pixel.
    const auto most = [](std::uint32_t size, std::uint32_t k, std::uint32_t s, std::uint32_t more) {
        return ((size - 1) * s + k + more - 1) / 2;
    };
    c.transpose.padding = {std::min(padding.h, most(x.h, kernel.h, stride.h, extra.h)),
                           std::min(padding.w, most(x.w, kernel.w, stride.w, extra.w))};
    return c;
}

// A shape of the fast kernels at another size, for the kernels that `prototype` has and no other.
inline ConvCase resizedConvCase(const ConvCase& prototype, std::uint32_t index)
{
    ConvCaseDice dice(index);
    ConvCase c = prototype;
    c.x = {dice.pick(1, 3), prototype.x.c, dice.pick(4, 13),
           prototype.x.w % 4 == 0 ? 8 * dice.pick(2, 5) : 2 * dice.pick(4, 20) + 1};
    return c;
}

// Random shapes: of five, four of any kind and one of the fast kernels.
inline std::vector<ConvCase> randomConvCases(std::uint32_t count)
{
    std::vector<ConvCase> fast = rowConvCases();
    for (const std::vector<ConvCase>& more : {quadConvCases(), channelConvCases()})
        fast.insert(fast.end(), more.begin(), more.end());
    std::vector<ConvCase> cases;
    for (std::uint32_t i = 0; i < count; ++i)
        cases.push_back(i % 5 == 4 ? resizedConvCase(fast[i / 5 % fast.size()], i)
                                   : anyConvCase(i));
    return cases;
}

} // namespace strandlight::test
