// The table behind the specular default: GGX slices as sums of four SGs times the clamped cosine.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "engine/base/image.hpp"
#include "engine/vk/image.hpp"
#include "shaders/shared/sg_specular.h"

namespace strandlight {

// rows[k] is one RGBA image [kSpecularTableViews, kSpecularTableAlphas] of lobe k < 4: (axis.x,
// axis.z) ln(1 + sharpness), the lobe's share of the energy, and in the fourth channel: f0 scale (k
// = 0), f90 bias (k = 1), else 0. rows[4] and rows[5] hold the lobes' mean directions, cosine
// included, in the same form: 0 and 1, 2 and 3.
struct SpecularTable
{
    std::vector<CpuImage> rows; // [6]

    // What the shader samples: bilinear interpolation at (alpha, cosView). Twin of
    // shaders/sg/specular_models.glsl.
    gpu::SgMixture mixture(float alpha, glm::vec3 normal, glm::vec3 view) const;
};

// Fits the table: deterministic, about a quarter of a second on one core. Computed once per process
// and kept.
const SpecularTable& specularTable();

// The same as six layers of an RGBA32F image.
Image uploadSpecularTable(Context& context);

} // namespace strandlight
