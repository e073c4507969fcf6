// The optimiser as a pass. Twin: reference/adam.hpp
#pragma once

#include <cstdint>

#include "compute_nn/adam_settings.hpp"
#include "compute_nn/parameters.hpp"

namespace strandlight {

// Checks parameters, moments and gradients, then takes step `step` (from 1) over all parameters, or
// skips it and counts the skip when this step's checks refused a value. A skipped step does not
// shift the numbering of later ones.
void addAdamPass(RenderGraph& graph, ParameterIds& parameters, const AdamSettings& settings,
                 std::uint32_t step);

} // namespace strandlight
