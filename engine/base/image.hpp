// A picture on the CPU: linear RGBA, fp32, row 0 on top.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace strandlight {

struct CpuImage
{
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<glm::vec4> pixels; // [height, width], row-major

    CpuImage() = default;
    CpuImage(std::uint32_t w, std::uint32_t h, glm::vec4 fill = glm::vec4(0.0f))
        : width(w), height(h), pixels(std::size_t(w) * h, fill)
    {
    }

    glm::vec4& at(std::uint32_t x, std::uint32_t y) { return pixels[std::size_t(y) * width + x]; }
    const glm::vec4& at(std::uint32_t x, std::uint32_t y) const
    {
        return pixels[std::size_t(y) * width + x];
    }
};

} // namespace strandlight
