// Shapes. Tensors are planar, row-major [N,C,H,W], of floats but for what inference stores as
// halves.
#pragma once

#include <cstdint>
#include <string>

namespace strandlight {

enum class Element : std::uint32_t
{
    Float,
    Half // storage only: loaded to floats, rounded when stored
};
constexpr std::uint32_t elementBytes(Element element)
{
    return element == Element::Float ? 4 : 2;
}

struct TensorDesc
{
    std::uint32_t n = 1; // images in the batch
    std::uint32_t c = 1; // channels
    std::uint32_t h = 1;
    std::uint32_t w = 1;

    std::uint64_t elements() const { return std::uint64_t(n) * c * h * w; }
    std::uint64_t bytes(Element element = Element::Float) const
    {
        return elements() * elementBytes(element);
    }
    std::uint32_t pixels() const { return h * w; } // of one plane
    friend bool operator==(const TensorDesc&, const TensorDesc&) = default;
};

// "[2,24,19,33]"
inline std::string shapeText(const TensorDesc& desc)
{
    return "[" + std::to_string(desc.n) + "," + std::to_string(desc.c) + "," +
           std::to_string(desc.h) + "," + std::to_string(desc.w) + "]";
}

} // namespace strandlight
