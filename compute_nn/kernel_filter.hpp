// A filter whose 3x3 kernel a network predicts for each pixel, as passes. Twin:
// reference/kernel_filter.hpp
// Bako et al. Kernel-Predicting Convolutional Networks for Denoising Monte Carlo Renderings. 2017
#pragma once

#include <string_view>

#include "compute_nn/tensor.hpp"

namespace strandlight {

// logits [N,9,H,W] (row major, dy = -1..1, dx = -1..1), image [N,4,H,W] -> y [N,4,H,W] =
// sum over taps of softmax(logits) image, overwritten. Taps outside the image have weight 0 and no
// part in the softmax. All may be channel ranges. Throws Error when shapes do not fit.
TensorId kernelFilterForward(RenderGraph& graph, std::string_view name, const TensorId& logits,
                             const TensorId& image, const TensorId& y);

// dY [N,4,H,W] -> dLogits [N,9,H,W], overwritten; 0 for taps outside. The image gets no gradient.
// Saved: logits, image.
TensorId kernelFilterBackward(RenderGraph& graph, std::string_view name, const TensorId& logits,
                              const TensorId& image, const TensorId& dY, const TensorId& dLogits);

} // namespace strandlight
