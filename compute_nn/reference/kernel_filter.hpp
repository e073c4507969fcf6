// Plain CPU twin of the predicted 3x3 kernel, forward and backward.
// Bako et al. Kernel-Predicting Convolutional Networks for Denoising Monte Carlo Renderings. 2017
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "compute_nn/tensor_desc.hpp"
#include "shaders/shared/nn_types.h"

namespace strandlight::reference {

// Weights of one pixel's taps: the softmax over those inside the image, 0 for the others.
template <class T>
std::array<T, gpu::kFilterTaps> filterWeights(const std::array<T, gpu::kFilterTaps>& logits,
                                              const std::array<bool, gpu::kFilterTaps>& inside)
{
    T largest = -std::numeric_limits<T>::infinity(), sum = T(0);
    for (std::size_t k = 0; k < gpu::kFilterTaps; ++k)
        if (inside[k] && !(logits[k] <= largest)) // NaN is taken and spreads
            largest = logits[k];
    std::array<T, gpu::kFilterTaps> weights{};
    for (std::size_t k = 0; k < gpu::kFilterTaps; ++k)
        if (inside[k])
            sum += weights[k] = std::exp(logits[k] - largest);
    for (T& weight : weights)
        weight /= sum;
    return weights;
}

// Calls visit(pixel (n, y, x) as n H W + y W + x, weights [9], offset of each tap in a plane,
// inside [9]) for every pixel.
template <class T, class Visit>
void forEachFilter(const TensorDesc& image, std::span<const T> logits, Visit visit)
{
    const std::size_t plane = image.pixels();
    for (std::uint32_t n = 0; n < image.n; ++n)
        for (std::uint32_t y = 0; y < image.h; ++y)
            for (std::uint32_t x = 0; x < image.w; ++x) {
                std::array<T, gpu::kFilterTaps> values{};
                std::array<bool, gpu::kFilterTaps> inside{};
                std::array<std::size_t, gpu::kFilterTaps> at{};
                for (std::uint32_t k = 0; k < gpu::kFilterTaps; ++k) {
                    const std::uint32_t ty = y + k / 3 - 1, tx = x + k % 3 - 1; // wraps below 0
                    inside[k] = ty < image.h && tx < image.w;
                    at[k] = inside[k] ? std::size_t(ty) * image.w + tx : 0;
                    values[k] = logits[(n * gpu::kFilterTaps + k) * plane + y * image.w + x];
                }
                visit(n, std::size_t(y) * image.w + x, filterWeights<T>(values, inside), at);
            }
}

// logits [N,9,H,W], x [N,4,H,W] -> y [N,4,H,W] (overwritten)
template <class T>
void kernelFilter(const TensorDesc& image, std::span<const T> logits, std::span<const T> x,
                  std::span<T> y)
{
    const std::size_t plane = image.pixels();
    forEachFilter<T>(image, logits,
                     [&](std::size_t n, std::size_t pixel, const auto& weights, const auto& at) {
                         for (std::size_t c = n * image.c; c < (n + 1) * image.c; ++c) {
                             y[c * plane + pixel] = T(0);
                             for (std::size_t k = 0; k < gpu::kFilterTaps; ++k)
                                 y[c * plane + pixel] += weights[k] * x[c * plane + at[k]];
                         }
                     });
}

// dY [N,4,H,W] -> dLogits [N,9,H,W] (overwritten): with g_k = dY . x_k, w_k (g_k - sum_j w_j g_j).
template <class T>
void kernelFilterBackward(const TensorDesc& image, std::span<const T> logits, std::span<const T> x,
                          std::span<const T> dY, std::span<T> dLogits)
{
    const std::size_t plane = image.pixels();
    forEachFilter<T>(
        image, logits, [&](std::size_t n, std::size_t pixel, const auto& weights, const auto& at) {
            std::array<T, gpu::kFilterTaps> g{};
            T mean = T(0);
            for (std::size_t k = 0; k < gpu::kFilterTaps; ++k) {
                for (std::size_t c = n * image.c; c < (n + 1) * image.c; ++c)
                    g[k] += dY[c * plane + pixel] * x[c * plane + at[k]];
                mean += weights[k] * g[k];
            }
            for (std::size_t k = 0; k < gpu::kFilterTaps; ++k)
                dLogits[(n * gpu::kFilterTaps + k) * plane + pixel] = weights[k] * (g[k] - mean);
        });
}

} // namespace strandlight::reference
