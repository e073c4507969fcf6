// The weights of a network on the device: values, gradients and Adam's moments, one block each, and
// the counters that say what the optimiser did.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compute_nn/conv_passes.hpp"
#include "compute_nn/parameter_layout.hpp"
#include "compute_nn/safetensors.hpp"

namespace strandlight {

// What the optimiser has done so far.
struct OptimizerReport
{
    std::uint32_t stepsTaken = 0;
    std::uint32_t stepsSkipped = 0; // because a value was refused
    std::vector<std::string>
        refusedIn; // names of the tensors that held NaN, infinities or overflowing gradients
    std::vector<std::uint32_t> refused; // how many values, of each
};

class Parameters
{
public:
    // Initial values are a pure function of (layout, seed); moments are zero.
    Parameters(Context& context, ParameterLayout layout, std::uint32_t seed);

    const ParameterLayout& layout() const { return layout_; }
    void upload(std::span<const float> values); // [layout().count()]; moments start again
    std::vector<float> download() const { return values_.downloadAs<float>(); }
    OptimizerReport report() const;

    // As named tensors, with the moments when training is to go on: "<name>", "adam.m.<name>",
    // "adam.v.<name>".
    void save(Safetensors& file, bool withMoments) const;
    // Throws FileError(path, tensor, reason) when one is missing, misshapen or not finite.
    void load(const Safetensors& file, const std::string& path);

private:
    friend struct ParameterIds;
    ParameterLayout layout_;
    Buffer values_, gradient_, moment1_, moment2_; // [layout_.count()]
    Buffer status_;                                // [kStatusSlots], of one step
    Buffer counters_;                              // [kCounterSlots + kStatusSlots]
    std::vector<std::string> slotNames_; // of the checks, in the order of the latest graph
};

// The blocks as a graph sees them; every pass that writes one leaves its new version here.
struct ParameterIds
{
    ParameterIds(RenderGraph& graph, Parameters& parameters);

    LayerWeights weights(const std::string& layer) const; // "<layer>.weight" and ".bias", values
    LayerWeights gradients(const std::string& layer) const;

    // First thing of a training step: gradients and status to zero.
    void clearGradients(RenderGraph& graph);
    // Counts refused values of a tensor; a later Adam step is skipped when there is one. `limit`:
    // largest magnitude allowed.
    void checkFinite(RenderGraph& graph, const std::string& name, BufferId buffer,
                     std::uint32_t offset, std::uint32_t count, float limit);
    void checkFinite(RenderGraph& graph, const std::string& name, const TensorId& whole);

    BufferId values, gradient, moment1, moment2, status, counters;

private:
    Parameters* owner_;
    std::uint32_t slots_ = 0; // used in this graph step
};

} // namespace strandlight
