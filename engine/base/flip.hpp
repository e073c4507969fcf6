// The FLIP difference of two low-dynamic-range pictures: what an observer sees when they alternate.
// Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild. FLIP: A Difference Evaluator
// for Alternating Images. 2020
#pragma once

#include "engine/base/image.hpp"

namespace strandlight {

// A 0.7 m wide screen of 3840 pixels seen from 0.7 m: the paper's default observer.
inline constexpr double kFlipPixelsPerDegree = 3840.0 * 3.14159265358979323846 / 180.0;

// Both pictures linear; values are clamped to [0,1]. Result: error in x (0 equal, 1 most
// different), y = z = x. Throws Error when the sizes differ or are zero. Non-finite values are not
// allowed (assertion).
CpuImage computeFlip(const CpuImage& image, const CpuImage& reference,
                     double pixelsPerDegree = kFlipPixelsPerDegree);

} // namespace strandlight
