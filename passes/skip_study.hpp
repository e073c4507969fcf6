// What scenes cost that lack something, beside one that has everything: nothing unneeded may run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/vk/context.hpp"

namespace strandlight {

struct SkipRow
{
    std::string name;                // "full", "without hair", ...
    std::vector<std::string> passes; // of a frame
    std::vector<std::string> wrong;  // what ran and the scene does not need: then nothing is timed
    std::size_t skipped = 0;         // kinds of light or of passes, in bake and frame
    std::uint32_t captureDispatches = 0;
    std::uint32_t pipelines = 0; // made by bake and frame
    std::uint64_t lobes = 0;     // kept, of the radiance
    std::uint64_t environmentLobes = 0;
    std::uint64_t peakBytes = 0;    // of device memory
    double bakeSeconds = 0.0;       // least of `repeats`, after the checked one
    double frameMilliseconds = 0.0; // the same, by the device's clock
};

struct SkipSettings
{
    std::uint32_t atlas = 32;
    std::uint32_t samples = 2; // paths per direction
    std::uint32_t steps = 100; // of the fit
    std::uint32_t width = 160, height = 120;
    std::uint32_t strands = 1000;
    std::uint32_t repeats = 1;
};

// The room without its ceiling, under a sky, with a lamp, metal and a head of hair; the same
// without each of them; a furnace, a scene without light and one without anything. Each on a device
// of its own. The first row is the full scene.
std::vector<SkipRow> studySkips(const ContextSettings& device, const SkipSettings& settings = {});

} // namespace strandlight
