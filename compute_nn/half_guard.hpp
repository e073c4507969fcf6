// Tensors stored as halves hold magnitudes up to 65504: the passes that store them say here which
// layer made a larger one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/graph/render_graph.hpp"

namespace strandlight {

class HalfGuard
{
public:
    // Throws Error naming what is missing when the device cannot store halves.
    explicit HalfGuard(RenderGraph& graph);

    // For the pass that stores a layer: a uint, the bits of the largest magnitude beyond a half.
    Binding bind(PassBuilder& pass, std::string_view layer);
    void output(RenderGraph& graph) const; // when all passes are added

    // After the graph ran: throws Error naming the first layer that made what no half holds, and
    // the value. NaN counts.
    void check(const RenderGraph& graph) const;

private:
    BufferId largest_;
    std::vector<std::string> layers_;
};

} // namespace strandlight
