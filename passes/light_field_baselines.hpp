// Other ways to keep a light-field image per texel, to measure free SGs against: raw images,
// spherical harmonics, SGs of fixed direction. All reconstruct at a bilinear position between four
// texels, as shading would.
// O'Donnell. Precomputed Global Illumination in Frostbite. 2018 (SH L1)
// Ramamoorthi and Hanrahan. An Efficient Representation for Irradiance Environment Maps. 2001 (SH
// L2) Pettineo. SG Series, part 5. 2016 (fixed SGs by non-negative least squares)
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "passes/sg_fit_cells.hpp"

namespace strandlight {

struct LightFieldModel
{
    std::string name;
    double bytesPerTexel = 0.0; // fp16 storage
    double seconds = 0.0;       // to make it
    // Radiance [direction] at the point with these weights of these four texels.
    std::function<void(const glm::uvec4& texels, const glm::vec4& weights,
                       std::vector<glm::vec3>& image)>
        reconstruct;
    // The same light as lobes, for shading; null for raw images. Spherical harmonics within 1 %.
    std::shared_ptr<const SgField> lobes;
};

// The models borrow `problem`, which must outlive them.
LightFieldModel rawImageModel(const FitProblem& problem);
// bands 2 (L1, 4 coefficients) or 3 (L2, 9): least squares over the hemisphere.
LightFieldModel sphericalHarmonicModel(const FitProblem& problem, std::uint32_t bands);
// Fibonacci axes over the hemisphere, sharpness from their spacing, amplitudes by non-negative
// least squares.
LightFieldModel fixedSgModel(const FitProblem& problem, std::uint32_t lobes);
// Free lobes, interpolated as shading interpolates them.
LightFieldModel freeSgModel(const FitProblem& problem, SgField field, std::string name,
                            double seconds);

} // namespace strandlight
