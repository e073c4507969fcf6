// What a plan will allocate, before it does.
#include <algorithm>
#include <cstdio>

#include "engine/graph/plan.hpp"

namespace strandlight {

namespace {

std::string mebibytes(std::uint64_t bytes)
{
    char text[32];
    std::snprintf(text, sizeof text, "%8.2f MiB", double(bytes) / (1024.0 * 1024.0));
    return text;
}

} // namespace

std::string memoryLine(const std::string& label, std::uint64_t bytes)
{
    constexpr std::size_t kColumn = 26;
    return "  " + label + std::string(kColumn - std::min(label.size(), kColumn), ' ') +
           mebibytes(bytes) + "\n";
}

std::string memoryText(const GraphPlan& plan, std::size_t largest)
{
    std::vector<std::uint32_t> live;
    for (std::uint32_t i = 0; i < plan.resources.size(); ++i)
        if (plan.resources[i].used && plan.resources[i].aliased)
            live.push_back(i);
    const auto bytesOf = [&](std::uint32_t i) { return plan.description.resources[i].bytes(); };
    std::stable_sort(live.begin(), live.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return bytesOf(a) > bytesOf(b); });
    std::string text =
        memoryLine("transients, " + std::to_string(live.size()), plan.transientBytes) +
        memoryLine("sharing memory", plan.arenaBytes);
    for (std::size_t k = 0; k < std::min(largest, live.size()); ++k) {
        const PlannedResource& r = plan.resources[live[k]];
        text += "    " + mebibytes(bytesOf(live[k])) + "  passes " + std::to_string(r.firstPass) +
                " to " + std::to_string(r.lastPass) + " of " + std::to_string(plan.passes.size()) +
                ", at " + mebibytes(r.offset) + "  " + plan.description.resources[live[k]].name +
                "\n";
    }
    return text;
}

} // namespace strandlight
