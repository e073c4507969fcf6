// The closed forms of shaders/shared/stress_functions.h with every float a double: what differs
// from them is rounding alone. Constants keep their fp32 values, so this tells errors down to 1e-7.
#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

namespace strandlight {

struct StressOutputDouble
{
    glm::dvec4 x, y;
};

// `item` as StressInput: a, b, c, d. Not for the packing functions.
StressOutputDouble stressInDouble(std::uint32_t function, const std::array<glm::vec4, 4>& item);

} // namespace strandlight
