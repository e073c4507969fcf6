// The frozen result of compile(): which passes run, in what order, behind which barriers, in which
// memory. Pure data, made without a device; the executor only obeys.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/graph/description.hpp"

namespace strandlight {

struct PlannedBarrier
{
    std::uint32_t resource = 0;
    Usage before = Usage::None; // None: first use in this graph
    Usage after = Usage::None;
    bool alias = false; // the memory held another resource before
    friend bool operator==(const PlannedBarrier&, const PlannedBarrier&) = default;
};

struct PlannedPass
{
    std::uint32_t pass = 0; // index into GraphDescription::passes
    std::vector<PlannedBarrier> barriers;
};

struct PlannedResource
{
    bool used = false;
    bool aliased = false;        // lives in the shared arena
    std::uint32_t firstPass = 0; // positions in GraphPlan::passes
    std::uint32_t lastPass = 0;
    std::uint64_t offset = 0; // in the arena, by the sizes of the description
};

struct GraphPlan
{
    GraphDescription description;
    std::vector<PlannedPass> passes;
    std::vector<std::uint32_t> culled;
    std::vector<PlannedResource> resources;
    std::uint64_t transientBytes = 0; // sum of all live transients
    std::uint64_t arenaBytes = 0;     // what they need when memory is shared
};

// validate -> cull -> order -> lifetimes -> memory -> barriers. Throws GraphError naming pass and
// resource.
GraphPlan planGraph(const GraphDescription& description);

// One line a pass: what it waits for, reads and writes.
std::string toText(const GraphPlan& plan);
std::string toGraphviz(const GraphPlan& plan);
// "  label              1.23 MiB\n": one line of a memory plan.
std::string memoryLine(const std::string& label, std::uint64_t bytes);
// Bytes of the transients with and without shared memory, then the `largest` of them, one a line.
std::string memoryText(const GraphPlan& plan, std::size_t largest = 6);

} // namespace strandlight
