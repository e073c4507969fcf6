// Runs one closed form on both machines and hands each result to a judge.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "passes/stress/closed_forms.hpp"
#include "passes/stress/inputs.hpp"
#include "passes/stress/tally.hpp"

namespace strandlight {

// One tally for each machine: [0] C++, [1] device.
using Tallies = std::array<Tally, 2>;

inline Tallies tallies(const std::string& name, double tolerance, const std::string& unit)
{
    return {Tally(name + ", C++", tolerance, unit), Tally(name + ", device", tolerance, unit)};
}

inline void append(std::vector<StressRow>& rows, const Tallies& both)
{
    rows.push_back(both[0].row());
    rows.push_back(both[1].row());
}

// judge(machine, index, item, result)
template <class Judge>
void onBoth(Context& context, std::uint32_t function, std::span<const gpu::StressInput> items,
            Judge judge)
{
    for (std::size_t machine = 0; machine < 2; ++machine) {
        const std::vector<gpu::StressOutput> results =
            machine == 0 ? stressInCpp(function, items) : stressOnDevice(context, function, items);
        for (std::size_t i = 0; i < items.size(); ++i)
            judge(machine, i, items[i], results[i]);
    }
}

// make(index) for each index.
template <class Make> std::vector<gpu::StressInput> makeItems(std::uint32_t count, Make make)
{
    std::vector<gpu::StressInput> items;
    items.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i)
        items.push_back(make(i));
    return items;
}

inline bool inRange(float value, float low, float high)
{
    return value >= low && value <= high;
}

} // namespace strandlight
