#include "passes/sg_fit_irradiance.hpp"

#include <algorithm>
#include <cmath>

#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg.h"

namespace strandlight {
namespace {

constexpr double kLargestFactor = 2.0;

// Cosine-weighted mean radiance of a texel's image.
glm::dvec3 capturedIrradiance(const FitProblem& problem, std::size_t texel)
{
    glm::dvec3 sum(0.0);
    for (std::size_t d = 0; d < problem.directions.size(); ++d) {
        const glm::vec4& direction = problem.directions[d];
        const glm::vec3 radiance =
            gpu::unpackRgb9e5(problem.images[d * problem.texelCount() + texel]);
        sum += glm::dvec3(radiance) * double(direction.w * direction.z);
    }
    return sum;
}

// The same of its lobes, in the same directions.
glm::dvec3 fittedIrradiance(const FitProblem& problem, const SgLobe* lobes, std::uint32_t count)
{
    glm::dvec3 sum(0.0);
    for (std::uint32_t k = 0; k < count; ++k) {
        const float sharpness = std::exp(lobes[k].logSharpness);
        double cosine = 0.0;
        for (const glm::vec4& direction : problem.directions)
            cosine += double(direction.w * direction.z *
                             gpu::sgEvaluate(glm::vec3(direction), lobes[k].axis, sharpness));
        sum += glm::dvec3(lobes[k].amplitude) * cosine;
    }
    return sum;
}

} // namespace

std::uint64_t matchIrradiance(const FitProblem& problem, SgField& field)
{
    std::uint64_t held = 0;
    for (std::size_t texel = 0; texel < problem.texelCount(); ++texel) {
        if (!(problem.scales[texel] > 0.0f))
            continue;
        SgLobe* lobes = field.lobes.data() + texel * field.lobeCount;
        const glm::dvec3 wanted = capturedIrradiance(problem, texel);
        const glm::dvec3 given = fittedIrradiance(problem, lobes, field.lobeCount);
        for (int channel = 0; channel < 3; ++channel) {
            if (!(given[channel] > 0.0))
                continue;
            const double factor = wanted[channel] / given[channel];
            const double kept = std::clamp(factor, 1.0 / kLargestFactor, kLargestFactor);
            held += kept != factor ? 1 : 0;
            for (std::uint32_t k = 0; k < field.lobeCount; ++k)
                lobes[k].amplitude[channel] *= float(kept);
        }
    }
    return held;
}

} // namespace strandlight
