// What a bake will allocate on the device, stage by stage, before it does.
#pragma once

#include <cstdint>
#include <string>

#include "passes/bake.hpp"

namespace strandlight {

struct BakeMemory
{
    std::uint64_t sceneBytes = 0;   // while the bake lasts
    std::uint64_t captureBytes = 0; // beside the scene
    std::uint64_t encoderBytes = 0; // beside the scene; 0: --fit direct
    std::uint64_t directBytes = 0;  // beside the scene; 0: --fit cnn
    std::string text;               // one line each, their largest sum, the encoder's transients

    std::uint64_t peakBytes() const;
};

// Builds atlas and hierarchy, but allocates only the encoder's parameters. Not counted: staging,
// and what rounding to the device's alignment adds. Throws Error for a scene without triangles.
BakeMemory planBakeMemory(Context& context, const Scene& scene, const BakeSettings& settings);

} // namespace strandlight
