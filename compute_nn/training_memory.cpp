#include "compute_nn/training_memory.hpp"

namespace strandlight {

TrainingMemory planTrainingMemory(const ParameterLayout& layout, const GraphPlan& plan)
{
    constexpr std::uint64_t kBlocks = 4; // values, gradients, two moments
    TrainingMemory memory;
    const std::uint64_t values = layout.count() * sizeof(float);
    memory.parameterBytes = kBlocks * values;
    memory.transientBytes = plan.arenaBytes;
    memory.text = memoryLine("parameters", values) +
                  memoryLine("  with training state", memory.parameterBytes) + memoryText(plan);
    return memory;
}

} // namespace strandlight
