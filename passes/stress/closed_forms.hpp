// One closed form of shaders/shared/stress_functions.h on many inputs: on the device, as C++, and
// in double.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/vk/context.hpp"
#include "passes/stress/closed_forms_double.hpp"
#include "shaders/shared/stress_packing.h"

namespace strandlight {

std::vector<gpu::StressOutput> stressOnDevice(Context& context, std::uint32_t function,
                                              std::span<const gpu::StressInput> items);
std::vector<gpu::StressOutput> stressInCpp(std::uint32_t function,
                                           std::span<const gpu::StressInput> items);

inline StressOutputDouble stressInDouble(std::uint32_t function, const gpu::StressInput& item)
{
    return stressInDouble(function, std::array<glm::vec4, 4>{item.a, item.b, item.c, item.d});
}

} // namespace strandlight
