// The numerical stress matrix: every formula and kernel on log-uniform and on special values, each
// result judged against a double reference. Tests run each group once and small; `strandlight
// stress` runs them for minutes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/vk/context.hpp"

namespace strandlight {

// What came of one function on one machine ("C++", "device").
struct StressRow
{
    std::string name;
    std::uint64_t cases = 0;
    std::uint64_t refused =
        0; // outside the documented domain: refused by whoever calls, or NaN that shows
    std::uint64_t nonFinite =
        0; // results that are NaN or infinite though the input was in the domain
    std::uint64_t misses =
        0; // results beyond the tolerance or outside their bounds; non-finite ones count too
    std::uint64_t clamped = 0; // values that were clamped and said so
    double worst = 0.0;        // largest error over its tolerance
    double tolerance = 0.0;
    std::string unit;       // what the tolerance is relative to
    std::string worstInput; // of `worst`, or of the first miss

    bool pass() const { return misses == 0 && cases > 0; }
};

// How much of a group: `items` random inputs per function; the special values always come in full.
struct StressSettings
{
    std::uint32_t seed = 1;
    std::uint32_t items = 2048;       // random inputs of each closed form
    std::uint32_t shapes = 8;         // random shapes of each kernel
    std::uint32_t steps = 200;        // of adversarial training
    std::uint32_t largest = 1u << 20; // elements of the largest reduction
};

struct StressGroup
{
    const char* name;
    const char* about;
    std::vector<StressRow> (*run)(Context& context, const StressSettings& settings);
};

// In the order in which they are run; the cheap ones first.
std::span<const StressGroup> stressGroups();

std::vector<StressRow> stressLobes(Context& context, const StressSettings& settings);
std::vector<StressRow> stressScattering(Context& context, const StressSettings& settings);
std::vector<StressRow> stressStorage(Context& context, const StressSettings& settings);
std::vector<StressRow> stressElementwise(Context& context, const StressSettings& settings);
std::vector<StressRow> stressConvolutions(Context& context, const StressSettings& settings);
std::vector<StressRow> stressMixtures(Context& context, const StressSettings& settings);
std::vector<StressRow> stressOptimiser(Context& context, const StressSettings& settings);
std::vector<StressRow> stressTraces(Context& context, const StressSettings& settings);
std::vector<StressRow> stressAdversaries(Context& context, const StressSettings& settings);

} // namespace strandlight
