// Small pictures for the tests of image metrics.
#pragma once

#include <cstdint>

#include "engine/base/image.hpp"
#include "shaders/shared/rng.h"

namespace strandlight::test {

inline CpuImage makeSolid(glm::vec3 colour, std::uint32_t width = 40, std::uint32_t height = 30)
{
    return CpuImage(width, height, glm::vec4(colour, 1.0f));
}

inline CpuImage makeNoise(std::uint32_t width, std::uint32_t height, std::uint32_t seed)
{
    CpuImage image(width, height);
    for (std::uint32_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = glm::vec4(gpu::uniform3(i, 0, 0, seed), 1.0f);
    return image;
}

inline double meanOf(const CpuImage& image)
{
    double sum = 0.0;
    for (const glm::vec4& p : image.pixels)
        sum += p.x;
    return sum / static_cast<double>(image.pixels.size());
}

} // namespace strandlight::test
