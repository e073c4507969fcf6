#include "engine/graph/barrier_planner.hpp"

#include <set>

namespace strandlight {

namespace {

// Image layouts differ between these groups of uses; within a group none changes.
int layoutGroup(Usage usage)
{
    switch (usage) {
    case Usage::ShaderRead:
    case Usage::ShaderWrite:
        return 1; // general
    case Usage::Sample:
        return 2;
    case Usage::ColorAttachment:
        return 3;
    case Usage::DepthAttachment:
        return 4;
    case Usage::DepthRead:
        return 5;
    case Usage::TransferRead:
        return 6;
    case Usage::TransferWrite:
        return 7;
    case Usage::None:
    case Usage::IndirectArguments:
        return 0;
    }
    return 0;
}

// What has happened to a resource so far.
struct History
{
    Usage lastWrite = Usage::None;
    std::set<Usage> readsSinceWrite; // each of them already sees the last write
    Usage last = Usage::None;        // images: whose layout it is in
    bool touched = false;
};

} // namespace

bool needsBarrier(ResourceKind kind, Usage before, Usage after)
{
    if (writes(before) || writes(after))
        return true;
    return kind == ResourceKind::Image && layoutGroup(before) != layoutGroup(after);
}

void planBarriers(GraphPlan& plan)
{
    std::vector<History> histories(plan.resources.size());
    for (std::uint32_t position = 0; position < plan.passes.size(); ++position) {
        PlannedPass& planned = plan.passes[position];
        for (const UseDescription& use : plan.description.passes[planned.pass].uses) {
            const ResourceDescription& resource = plan.description.resources[use.resource];
            History& history = histories[use.resource];
            if (!history.touched) {
                // First use: images get their layout; a transient may take over another's memory.
                const bool alias = plan.resources[use.resource].aliased;
                if (alias || resource.kind == ResourceKind::Image)
                    planned.barriers.push_back({use.resource, Usage::None, use.usage, alias});
            } else if (needsBarrier(resource.kind, history.last, use.usage)) {
                planned.barriers.push_back({use.resource, history.last, use.usage, false});
                // A write after several kinds of reads waits for each of them. Those of an image
                // differ in layout, so the last one has already waited for the others.
                if (writes(use.usage) && resource.kind == ResourceKind::Buffer)
                    for (const Usage read : history.readsSinceWrite)
                        if (read != history.last)
                            planned.barriers.push_back({use.resource, read, use.usage, false});
            } else if (history.lastWrite != Usage::None &&
                       !history.readsSinceWrite.count(use.usage)) {
                // Another kind of reader of the same data: it has to see the write as well.
                planned.barriers.push_back({use.resource, history.lastWrite, use.usage, false});
            }
            if (writes(use.usage)) {
                history.lastWrite = use.usage;
                history.readsSinceWrite.clear();
            } else {
                history.readsSinceWrite.insert(use.usage);
            }
            history.last = use.usage;
            history.touched = true;
        }
    }
}

} // namespace strandlight
