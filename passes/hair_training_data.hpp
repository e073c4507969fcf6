// Frames that the filter network learns from: what it reads, in several noises, and what it should
// say, the supersampled truth of strands of true width.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/vk/context.hpp"
#include "passes/hair_training_look.hpp"
#include "shaders/shared/hair_types.h"

namespace strandlight {

struct HairTrainingSettings
{
    std::uint32_t size = 320;         // pixels a side, a multiple of 8
    std::uint32_t repeats = 4;        // noises, a multiple of 2
    std::uint32_t targetSamples = 64; // a multiple of 8: half of them under each shadow noise
    float strandShare = 1.0f;         // of the look's strands, in (0, 1], wider by its root
};

// Planes of one repeat: 26 as kHairInputPlanes says, then the premultiplied radiance that is
// blended and that of the four samples' mean.
inline constexpr std::uint32_t kHairBlendedPlane = gpu::kHairInputPlanes;
inline constexpr std::uint32_t kHairMeanPlane = kHairBlendedPlane + 3;
inline constexpr std::uint32_t kHairRepeatPlanes = kHairMeanPlane + 3;
// Of the truth: premultiplied radiance (3), transmittance, premultiplied illumination.
inline constexpr std::uint32_t kHairTargetPlanes = 5;
// Of a plain average: premultiplied radiance (3), transmittance.
inline constexpr std::uint32_t kHairAveragePlanes = 4;
// Samples of the averages that held-out frames carry for comparison.
inline constexpr std::array<std::uint32_t, 2> kHairAverageSamples = {16, 64};

// Half floats, planar. Radiance is linear; log-space inputs are as the network reads them.
struct HairTrainingFrame
{
    std::uint32_t size = 0;
    std::uint32_t repeats = 0;
    bool hasAverages = false;
    std::vector<std::uint16_t> planes; // [repeats][32], target [5], averages [2][4]; [size, size]

    std::size_t planeCount() const;
    std::size_t repeatPlane(std::uint32_t repeat) const { return repeat * kHairRepeatPlanes; }
    std::size_t targetPlane() const { return repeats * kHairRepeatPlanes; }
    std::size_t averagePlane(std::uint32_t i) const
    {
        return targetPlane() + kHairTargetPlanes + i * kHairAveragePlanes;
    }
    float at(std::size_t plane, std::uint32_t x, std::uint32_t y) const;
};

void checkHairTrainingSettings(const HairTrainingSettings& settings); // throws Error

// Renders it. Of four repeats, two thin strands out as the automatic level of detail does. Held-out
// frames get the averages. Throws Error for settings out of range.
HairTrainingFrame makeHairTrainingFrame(Context& context, const HairTrainingLook& look,
                                        const HairTrainingSettings& settings, bool heldOut);

} // namespace strandlight
