// Everything a RenderGraph holds. Included by render_graph.cpp, pass_builder.cpp and the executor.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "engine/graph/commands.hpp"
#include "engine/graph/plan.hpp"
#include "engine/graph/render_graph.hpp"

namespace strandlight {

class GraphResources; // the Vulkan side of one execution, engine/graph/executor.hpp

struct RenderGraph::State
{
    Context* context = nullptr; // null: planning only
    GraphDescription description;
    std::vector<PassCommands> commands;   // [passes]
    std::vector<Buffer*> importedBuffers; // [resources], null where not
    std::vector<Image*> importedImages;   // [resources]
    std::deque<Buffer> uploads;           // contents given by uploadBuffer
    std::optional<GraphPlan> plan;
    std::unique_ptr<GraphResources> resources;
    Timings timed = Timings::None;
    std::vector<PassTiming> timings;

    // Registers a use; returns the version the caller may bind from now on. Throws GraphError on
    // stale handles.
    std::uint32_t use(std::uint32_t pass, std::uint32_t resource, std::uint32_t version,
                      Usage usage);
    std::uint32_t addResource(ResourceDescription resource);
};

} // namespace strandlight
