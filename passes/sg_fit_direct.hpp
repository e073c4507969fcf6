// The direct fit on the device: Adam over the lobes of all texels together, two kernels a step.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/graph/render_graph.hpp"
#include "engine/vk/buffer.hpp"
#include "passes/sg_fit_cells.hpp"
#include "passes/sg_fit_settings.hpp"

namespace strandlight {

// A range of cells and the images of the texels that they touch: one dispatch and one binding.
struct SgFitChunk
{
    std::uint32_t firstCell = 0;
    std::uint32_t cellCount = 0;
    std::uint32_t firstTexel = 0;
    std::uint32_t texelCount = 0;
};

// Ranges of cells so that the images of each take at most `imageBytes` and each has at most
// `maximumCells`.
std::vector<SgFitChunk> splitFitCells(const FitProblem& problem, std::uint64_t imageBytes,
                                      std::uint32_t maximumCells);

// What DirectFit allocates for this problem, whose images may be missing.
std::uint64_t directFitBytes(const Context& context, const FitProblem& problem);

// The numbers of a fit that its passes need.
struct SgFitShape
{
    std::uint32_t texelCount = 0;
    std::uint32_t cellCount = 0;
    std::uint32_t lobes = 0;
    std::uint32_t directionCount = 0;
    std::uint32_t directionsPerStep = 0; // divides directionCount
    float minimumLogSharpness = 0.0f;
    float maximumLogSharpness = 0.0f;
    FitSettings settings;
    std::vector<SgFitChunk> chunks;
};

// The buffers as a graph sees them; every step leaves its new versions here.
struct SgFitStepIds
{
    std::vector<BufferId> images; // [chunk] uint [direction, texel] RGB9E5
    BufferId corners;             // uint [4, cell]
    BufferId gather;              // uint [4, texel]
    BufferId neighbours;          // uint [4, texel]
    BufferId directions;          // vec4 [direction]
    BufferId scales;              // float [texel]
    BufferId before, after;       // vec4 [lobe * 2 + half, texel]; swapped by every step
    BufferId moments1;            // vec4 [lobe * 2 + half, texel]
    BufferId moments2;            // vec4 [lobe, texel] (axis, sharpness, amplitude, 0)
    BufferId gradients;           // vec4 [lobe * 2 + half, cell]
    BufferId losses;              // float [cell]
    BufferId counters;            // uint [1] updates refused because a gradient was not finite
};

// Step `step` (from 0): gradients of every cell, then an update of every texel.
void addSgFitStepPass(RenderGraph& graph, const SgFitShape& shape, SgFitStepIds& ids,
                      std::uint32_t step);

// The fit's memory on the device, from a start to lobes.
class DirectFit
{
public:
    // Uploads problem and start; borrows only the context. Throws Error when a buffer would pass
    // the device's binding limit.
    DirectFit(Context& context, const FitProblem& problem, const FitSettings& settings,
              const FitState& start);

    // Runs `steps` further steps in one submit and waits.
    void run(std::uint32_t steps);

    std::uint32_t step() const { return step_; }
    FitState state() const;
    double loss() const; // of the latest step, mean over cells
    // Gradients of the latest step, as sg_fit_cells wrote them; for tests.
    std::vector<float> gradients() const { return gradients_.downloadAs<float>(); }

private:
    SgFitStepIds import(RenderGraph& graph);

    Context* context_;
    SgFitShape shape_;
    std::uint32_t step_ = 0;
    std::uint64_t skippedBefore_ = 0; // by the run that this one resumes
    std::vector<Buffer> images_;
    Buffer corners_, gather_, neighbours_, directions_, scales_;
    Buffer parameters_[2]; // the live one is parameters_[step_ % 2]
    Buffer moments1_, moments2_, gradients_, losses_, counters_;
};

} // namespace strandlight
