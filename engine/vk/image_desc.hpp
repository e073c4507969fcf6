// What an image is: size, layers, format, samples.
#pragma once

#include <cstdint>

namespace strandlight {

enum class Format : std::uint32_t
{
    R32F,
    R32UI,
    RG32F,
    RGBA8,
    RGBA16F,
    RGBA32F,
    R16F,
    Depth32F
};

std::uint32_t bytesPerPixel(Format format);
const char* toString(Format format);

struct ImageDesc
{
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    std::uint32_t layers = 1; // > 1: a 2D array
    Format format = Format::RGBA32F;
    std::uint32_t samples = 1; // 1 or 4

    ImageDesc with(Format other) const
    {
        ImageDesc copy = *this;
        copy.format = other;
        return copy;
    }
    std::uint64_t bytes() const
    {
        return std::uint64_t(width) * height * layers * samples * bytesPerPixel(format);
    }
    friend bool operator==(const ImageDesc&, const ImageDesc&) = default;
};

} // namespace strandlight
