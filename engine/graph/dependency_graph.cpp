#include "engine/graph/dependency_graph.hpp"

#include <algorithm>
#include <map>
#include <queue>

#include "engine/base/error.hpp"

namespace strandlight {

std::vector<std::vector<std::uint32_t>> findDependencies(const GraphDescription& description)
{
    using Version = std::pair<std::uint32_t, std::uint32_t>; // resource, version
    std::map<Version, std::uint32_t> writer;
    std::map<Version, std::vector<std::uint32_t>> readers;
    for (std::uint32_t pass = 0; pass < description.passes.size(); ++pass)
        for (const UseDescription& use : description.passes[pass].uses) {
            if (writes(use.usage))
                writer[{use.resource, use.version + 1}] = pass;
            else
                readers[{use.resource, use.version}].push_back(pass);
        }

    std::vector<std::vector<std::uint32_t>> needs(description.passes.size());
    for (std::uint32_t pass = 0; pass < description.passes.size(); ++pass)
        for (const UseDescription& use : description.passes[pass].uses) {
            const Version version{use.resource, use.version};
            if (const auto found = writer.find(version); found != writer.end())
                needs[pass].push_back(found->second);
            if (writes(use.usage))
                for (const std::uint32_t reader : readers[version])
                    needs[pass].push_back(
                        reader); // write after read: the old contents must have been seen
        }
    return needs;
}

std::vector<bool> findLivePasses(const GraphDescription& description,
                                 const std::vector<std::vector<std::uint32_t>>& needs)
{
    std::vector<bool> live(description.passes.size(), false);
    std::vector<std::uint32_t> stack;
    const auto mark = [&](std::uint32_t pass) {
        if (!live[pass]) {
            live[pass] = true;
            stack.push_back(pass);
        }
    };
    for (std::uint32_t pass = 0; pass < description.passes.size(); ++pass) {
        bool root = description.passes[pass].keep;
        for (const UseDescription& use : description.passes[pass].uses) {
            const ResourceDescription& resource = description.resources[use.resource];
            root = root || (writes(use.usage) && (resource.imported || resource.output));
        }
        if (root)
            mark(pass);
    }
    // Readers are not needed for the sake of a later write: only producers keep a pass alive.
    while (!stack.empty()) {
        const std::uint32_t pass = stack.back();
        stack.pop_back();
        for (const std::uint32_t before : needs[pass]) {
            const bool produces =
                std::any_of(description.passes[before].uses.begin(),
                            description.passes[before].uses.end(), [&](const UseDescription& made) {
                                return writes(made.usage) &&
                                       std::any_of(description.passes[pass].uses.begin(),
                                                   description.passes[pass].uses.end(),
                                                   [&](const UseDescription& use) {
                                                       return use.resource == made.resource &&
                                                              use.version == made.version + 1;
                                                   });
                            });
            if (produces)
                mark(before);
        }
    }
    return live;
}

std::vector<std::uint32_t> orderPasses(const GraphDescription& description,
                                       const std::vector<std::vector<std::uint32_t>>& needs,
                                       const std::vector<bool>& live)
{
    const std::uint32_t count = std::uint32_t(description.passes.size());
    std::vector<std::uint32_t> waiting(count, 0);
    std::vector<std::vector<std::uint32_t>> followers(count);
    std::uint32_t liveCount = 0;
    for (std::uint32_t pass = 0; pass < count; ++pass) {
        if (!live[pass])
            continue;
        ++liveCount;
        for (const std::uint32_t before : needs[pass])
            if (live[before]) {
                ++waiting[pass];
                followers[before].push_back(pass);
            }
    }
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> ready;
    for (std::uint32_t pass = 0; pass < count; ++pass)
        if (live[pass] && waiting[pass] == 0)
            ready.push(pass);
    std::vector<std::uint32_t> order;
    while (!ready.empty()) {
        const std::uint32_t pass = ready.top();
        ready.pop();
        order.push_back(pass);
        for (const std::uint32_t follower : followers[pass])
            if (--waiting[follower] == 0)
                ready.push(follower);
    }
    if (order.size() != liveCount) {
        std::string names;
        for (std::uint32_t pass = 0; pass < count; ++pass)
            if (live[pass] && waiting[pass] != 0)
                names += (names.empty() ? "'" : ", '") + description.passes[pass].name + "'";
        throw GraphError("passes wait for each other: " + names);
    }
    return order;
}

} // namespace strandlight
