// Random and awkward convolution shapes, shared by the tests of the twins and of the kernels.
#pragma once

#include <cstdint>
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

// `count` cases: first the corners that break index arithmetic, then random ones. Channels up to
// 33, sides up to 13.
inline std::vector<ConvCase> convCases(std::uint32_t count)
{
    std::vector<ConvCase> cases = {
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
    for (std::uint32_t i = std::uint32_t(cases.size()); i < count; ++i) {
        const auto pick = [&](std::uint32_t dimension, std::uint32_t low, std::uint32_t high) {
            const float u = gpu::uniform3(i, 0, dimension, 7).x;
            return low + std::uint32_t(u * float(high - low + 1));
        };
        const Extent2 kernel = {pick(0, 1, 5), pick(1, 1, 5)};
        const Extent2 stride = {pick(2, 1, 3), pick(3, 1, 3)};
        const Extent2 padding = {pick(4, 0, kernel.h / 2), pick(5, 0, kernel.w / 2)};
        const TensorDesc x = {pick(6, 1, 3), pick(7, 1, 33), pick(8, kernel.h, 13),
                              pick(9, kernel.w, 13)};
        cases.push_back(makeConvCase(x, pick(10, 1, 33), kernel, stride, padding,
                                     {pick(11, 0, stride.h - 1), pick(12, 0, stride.w - 1)}));
    }
    cases.resize(count);
    return cases;
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
    };
}

} // namespace strandlight::test
