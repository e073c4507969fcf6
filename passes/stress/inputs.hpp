// Inputs under stress: log-uniform numbers, directions, and the special values of every kind of
// number.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include <glm/glm.hpp>

#include "shaders/shared/stress_packing.h"

namespace strandlight {

inline constexpr std::array<float, 13> kSpecialValues = {0.0f,
                                                         std::numeric_limits<float>::epsilon(),
                                                         -std::numeric_limits<float>::epsilon(),
                                                         1e-38f,
                                                         1e-20f,
                                                         1e-6f,
                                                         1.0f,
                                                         1e4f,
                                                         1e6f,
                                                         1e30f,
                                                         std::numeric_limits<float>::max(),
                                                         std::numeric_limits<float>::infinity(),
                                                         std::numeric_limits<float>::quiet_NaN()};
inline constexpr std::uint32_t kSpecials = std::uint32_t(kSpecialValues.size());

// Digit `place` of `index` written to base 13, as a special value: counting walks the full cross
// product.
inline float specialValue(std::uint32_t index, std::uint32_t place)
{
    for (; place > 0; --place)
        index /= kSpecials;
    return kSpecialValues[index % kSpecials];
}

// Random numbers of one item: a pure function of (seed, item, dimension).
class StressRandom
{
public:
    StressRandom(std::uint32_t seed, std::uint32_t item) : seed_(seed), item_(item) {}

    float uniform() { return gpu::uniform3(item_, 0, dimension_++, seed_).x; }
    float uniform(float low, float high) { return low + (high - low) * uniform(); }
    float logUniform(float low, float high)
    {
        return std::exp(std::log(low) + (std::log(high) - std::log(low)) * uniform());
    }
    std::uint32_t integer(std::uint32_t low, std::uint32_t high) // both included
    {
        return low + std::uint32_t(double(high - low + 1) * double(uniform()));
    }
    glm::vec3 direction()
    {
        const glm::vec3 u = gpu::uniform3(item_, 0, dimension_++, seed_);
        const float z = 2.0f * u.x - 1.0f;
        const float r = std::sqrt(std::max(1.0f - z * z, 0.0f));
        return glm::normalize(
            glm::vec3(r * std::cos(6.2831853f * u.y), r * std::sin(6.2831853f * u.y), z));
    }
    // A unit vector about `angle` away from the unit vector `from`.
    glm::vec3 near(glm::vec3 from, float angle)
    {
        const glm::vec3 side = glm::cross(from, direction());
        const float length = glm::length(side);
        return length > 1e-6f
                   ? glm::normalize(from * std::cos(angle) + side * (std::sin(angle) / length))
                   : from;
    }

private:
    std::uint32_t seed_, item_, dimension_ = 0;
};

std::string describe(const gpu::StressInput& item);

} // namespace strandlight
