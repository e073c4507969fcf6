// What a training step will allocate, before it does.
#pragma once

#include <cstdint>
#include <string>

#include "compute_nn/parameter_layout.hpp"
#include "engine/graph/plan.hpp"

namespace strandlight {

struct TrainingMemory
{
    std::uint64_t parameterBytes = 0; // values, gradients and both moments
    std::uint64_t transientBytes = 0; // of the graph, sharing memory
    std::string text;                 // lines of both, and the largest transients

    std::uint64_t bytes() const { return parameterBytes + transientBytes; }
};

// `plan` is that of the graph of one step.
TrainingMemory planTrainingMemory(const ParameterLayout& layout, const GraphPlan& plan);

} // namespace strandlight
