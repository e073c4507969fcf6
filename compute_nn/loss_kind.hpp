// What a network is trained for.
#pragma once

#include <cstdint>

namespace strandlight {

// The values are part of the kernel (shaders/nn/loss.comp).
enum class LossKind : std::uint32_t
{
    MeanSquare, // (p - t)^2
    Relative,   // (p - t)^2 / (p^2 + 0.01), the denominator a constant for the gradient
    Log1p       // (ln(1 + p) - ln(1 + t))^2
};

} // namespace strandlight
