// FLIP as the paper writes it: whole two-dimensional kernels, no separation, its own constants. For
// tests only. Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild. FLIP: A Difference
// Evaluator for Alternating Images. 2020
#pragma once

#include <vector>

#include "engine/base/image.hpp"

namespace strandlight::test {

// [height, width]
std::vector<double> plainFlip(const CpuImage& image, const CpuImage& reference,
                              double pixelsPerDegree);
// Of two solid pictures: filters and features have no say.
double plainFlipOfColours(glm::dvec3 image, glm::dvec3 reference);

} // namespace strandlight::test
