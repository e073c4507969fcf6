#include "engine/graph/plan.hpp"

#include <sstream>

#include "engine/base/error.hpp"
#include "engine/graph/alias_planner.hpp"
#include "engine/graph/barrier_planner.hpp"
#include "engine/graph/dependency_graph.hpp"

namespace strandlight {

namespace {

constexpr std::uint64_t kPlanAlignment = 256; // covers the buffer alignments of every device seen

// Reading a transient that no pass has written is a mistake of the caller, found here and not on
// the screen.
void validate(const GraphDescription& description)
{
    for (const PassDescription& pass : description.passes)
        for (const UseDescription& use : pass.uses) {
            const ResourceDescription& resource = description.resources[use.resource];
            if (!writes(use.usage) && use.version == 0 && !resource.hasContents)
                throw GraphError("pass '" + pass.name + "' reads '" + resource.name +
                                 "', which no pass has written");
        }
    for (const ResourceDescription& resource : description.resources)
        if (resource.output && resource.version == 0 && !resource.hasContents)
            throw GraphError("'" + resource.name + "' is an output, but no pass writes it");
}

void planLifetimes(GraphPlan& plan)
{
    plan.resources.assign(plan.description.resources.size(), {});
    for (std::uint32_t position = 0; position < plan.passes.size(); ++position)
        for (const UseDescription& use : plan.description.passes[plan.passes[position].pass].uses) {
            PlannedResource& resource = plan.resources[use.resource];
            if (!resource.used)
                resource.firstPass = position;
            resource.used = true;
            resource.lastPass = position;
        }
}

void planTransientMemory(GraphPlan& plan)
{
    std::vector<MemoryRequest> requests;
    std::vector<std::uint32_t> owners;
    for (std::uint32_t i = 0; i < plan.resources.size(); ++i) {
        const ResourceDescription& resource = plan.description.resources[i];
        PlannedResource& planned = plan.resources[i];
        planned.aliased =
            planned.used && !resource.imported && !resource.hasContents && !resource.output;
        if (!planned.used || resource.imported)
            continue;
        plan.transientBytes += resource.bytes();
        if (planned.aliased) {
            requests.push_back(
                {resource.bytes(), kPlanAlignment, planned.firstPass, planned.lastPass});
            owners.push_back(i);
        } else {
            plan.arenaBytes += resource.bytes(); // outputs and uploads keep memory of their own
        }
    }
    const MemoryPlan memory = planMemory(requests);
    for (std::size_t i = 0; i < owners.size(); ++i)
        plan.resources[owners[i]].offset = memory.offsets[i];
    plan.arenaBytes += memory.bytes;
}

} // namespace

GraphPlan planGraph(const GraphDescription& description)
{
    GraphPlan plan;
    plan.description = description;
    validate(description);
    const auto needs = findDependencies(description);
    const std::vector<bool> live = findLivePasses(description, needs);
    for (const std::uint32_t pass : orderPasses(description, needs, live))
        plan.passes.push_back({pass, {}});
    for (std::uint32_t pass = 0; pass < live.size(); ++pass)
        if (!live[pass])
            plan.culled.push_back(pass);
    planLifetimes(plan);
    planTransientMemory(plan);
    planBarriers(plan);
    return plan;
}

std::string toText(const GraphPlan& plan)
{
    std::ostringstream out;
    for (const PlannedPass& planned : plan.passes) {
        const PassDescription& pass = plan.description.passes[planned.pass];
        out << pass.name << ":";
        for (const UseDescription& use : pass.uses)
            out << " " << plan.description.resources[use.resource].name << "@" << use.version << "("
                << toString(use.usage) << ")";
        for (const PlannedBarrier& barrier : planned.barriers)
            out << " | " << plan.description.resources[barrier.resource].name << " "
                << toString(barrier.before) << "->" << toString(barrier.after)
                << (barrier.alias ? " alias" : "");
        out << "\n";
    }
    for (const std::uint32_t pass : plan.culled)
        out << "culled: " << plan.description.passes[pass].name << "\n";
    out << "transients " << plan.transientBytes << " bytes in " << plan.arenaBytes << "\n";
    return out.str();
}

std::string toGraphviz(const GraphPlan& plan)
{
    std::ostringstream out;
    out << "digraph frame {\n  rankdir=LR;\n  node [shape=box];\n";
    for (const PlannedPass& planned : plan.passes) {
        const PassDescription& pass = plan.description.passes[planned.pass];
        out << "  p" << planned.pass << " [label=\"" << pass.name << "\", style=filled];\n";
        for (const UseDescription& use : pass.uses) {
            const ResourceDescription& resource = plan.description.resources[use.resource];
            const auto node = [&](std::uint32_t version) {
                return "r" + std::to_string(use.resource) + "_" + std::to_string(version);
            };
            const auto label = [&](std::uint32_t version) {
                out << "  " << node(version) << " [label=\"" << resource.name << "@" << version
                    << "\", shape=ellipse];\n";
            };
            label(use.version);
            out << "  " << node(use.version) << " -> p" << planned.pass << ";\n";
            if (writes(use.usage)) {
                label(use.version + 1);
                out << "  p" << planned.pass << " -> " << node(use.version + 1) << ";\n";
            }
        }
    }
    for (const std::uint32_t pass : plan.culled)
        out << "  p" << pass << " [label=\"" << plan.description.passes[pass].name
            << "\", style=dashed];\n";
    out << "}\n";
    return out.str();
}

} // namespace strandlight
