// From a scene to its baked light: atlas, capture, fit. The whole of `strandlight bake`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/vk/context.hpp"
#include "passes/savings.hpp"
#include "passes/sg_field.hpp"
#include "passes/sg_fit_settings.hpp"

namespace strandlight {

struct BakeSettings
{
    std::uint32_t atlasResolution = 128; // texels per side
    std::uint32_t lightfieldSize = 16;   // directions per side of the hemi-octahedral image
    std::uint32_t lobes = 8;
    std::uint32_t environmentLobes = 8; // for the second set, when the scene has an environment
    std::uint32_t samplesPerDirection = 8;
    std::uint32_t bounces = 16;
    std::uint32_t steps = FitSettings{}.steps;
    std::uint32_t seed = 1;
    FitMode fit = FitMode::Direct;
    // Lobes are dropped, tile by tile, while the fit's error grows by no more than this fraction;
    // 0: every texel keeps all (passes/sg_prune.hpp). 0.08 leaves 68 % of the built-in room's bytes
    // and 29 % of cornell_lambert's, with FLIP within 1 % (`bench gi`).
    float lobeError = 0.08f;
    std::uint32_t lobeTile = FitSettings{}.lobeTile; // texels a side that keep the same lobes
    // Where work in progress is kept, and continued from when `resume` is set. Empty: nowhere.
    // An interrupted bake that is resumed gives the same bytes as one that was not.
    std::filesystem::path checkpoint;
    bool resume = false;
};

struct BakeStatistics
{
    std::uint32_t texels = 0;        // covered
    std::uint32_t skippedTexels = 0; // inside geometry
    std::uint32_t emptyTexels = 0;   // of the atlas, without surface: not captured
    double atlasSeconds = 0.0;
    double captureSeconds = 0.0;
    double fitSeconds = 0.0;
    std::uint32_t captureDispatches = 0;
    BakeSavings savings;
    std::vector<std::string> skipped; // what the scene did not need, and why
    double radianceRmse = 0.0;        // light field against its lobes, at texels
    double environmentRmse = 0.0;
    std::uint64_t peakDeviceBytes = 0;
};

// A scene without triangles, or without any light, is baked without a look at the device: nothing
// is captured or fitted, no texel keeps a lobe.
// Throws Error on a scene that cannot be baked, Interrupted when the user stops it (the checkpoint
// is then on disk).
SgBake bakeScene(Context& context, const Scene& scene, const BakeSettings& settings,
                 BakeStatistics* statistics = nullptr);

} // namespace strandlight
