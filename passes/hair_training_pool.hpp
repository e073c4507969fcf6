// A folder of training frames, one file each. Frame i depends on (seed, i) and the settings alone,
// so a pool that was cut short goes on where it stopped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "passes/hair_training_data.hpp"

namespace strandlight {

struct HairPoolSettings
{
    std::filesystem::path folder;
    std::uint32_t seed = 1;
    std::uint32_t first = 0;    // number of the first frame: a pool may be filled in parts
    std::uint32_t frames = 96;  // to train on
    std::uint32_t heldOut = 6;  // to judge by
    HairTrainingSettings frame; // of held-out frames, targetSamples is kHeldOutSamples times that
};

inline constexpr std::uint32_t kHeldOutSamples = 4;

struct HairPool
{
    std::vector<HairTrainingFrame> frames;
    std::vector<HairTrainingFrame> heldOut;
    std::vector<std::string> heldOutNames; // style and view
    std::uint32_t identity = 0;            // of seed and frame settings
};

// Renders the frames that the folder lacks, then loads all but those without hair (the head may
// hide what the camera looks at). Throws FileError for files that are broken or were made with
// other settings, Interrupted between frames; files made so far stay.
HairPool openHairPool(Context& context, const HairPoolSettings& settings);

} // namespace strandlight
