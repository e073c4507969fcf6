// Tensors of random numbers for kernels under stress, and how numbers are named in a row.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shaders/shared/rng.h"

namespace strandlight {

// Uniform in [-1.2, 1.2) x scale: a pure function of (seed, i).
inline std::vector<float> stressTensor(std::uint64_t count, std::uint32_t seed, float scale = 1.0f)
{
    std::vector<float> values(count);
    for (std::uint64_t i = 0; i < count; ++i)
        values[i] = (2.4f * gpu::uniform3(std::uint32_t(i), 0, 0, seed).x - 1.2f) * scale;
    return values;
}

inline std::vector<double> toDouble(const std::vector<float>& values)
{
    return {values.begin(), values.end()};
}
inline std::vector<double> magnitudes(const std::vector<float>& values)
{
    std::vector<double> sizes;
    for (const float v : values)
        sizes.push_back(v < 0.0f ? -double(v) : double(v));
    return sizes;
}

std::string numberText(double value); // nine digits

} // namespace strandlight
