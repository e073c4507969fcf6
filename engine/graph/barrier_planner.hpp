// (use before, use after) -> barrier or none, for every resource along the order of passes. No
// Vulkan calls.
#pragma once

#include "engine/graph/plan.hpp"

namespace strandlight {

// Does the second use have to wait for, or see, the first? Reads of the same kind do not; images
// also change layout.
bool needsBarrier(ResourceKind kind, Usage before, Usage after);

// Fills in PlannedPass::barriers; passes, lifetimes and memory are already planned.
void planBarriers(GraphPlan& plan);

} // namespace strandlight
