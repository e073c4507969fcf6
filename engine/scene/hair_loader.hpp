// Hair from files: TressFX .tfx and Cem Yuksel's .hair.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "engine/scene/hair.hpp"

namespace strandlight {

// What stands in for values that a file does not give.
struct HairDefaults
{
    glm::vec3 color = glm::vec3(0.35f, 0.2f, 0.1f); // linear albedo; .tfx only, .hair has its own
    float colorVariation = 0.25f;                   // of a colour that is one for the whole file
    float diameterOfExtent = 2e-4f; // diameter over the bounds' diagonal: .tfx has no unit
    std::uint32_t seed = 0;
};

// Positions stay in the file's coordinates. A .hair file's transparency is checked and dropped:
// coverage comes from the width. Strands are tapered unless the file gives a thickness per point.
// Throws FileError (path, place, reason) when the file is broken.
HairStrands loadHair(const std::filesystem::path& path, const HairDefaults& defaults = {});

// The same for the bytes of a file; `path` gives the suffix, the name and the place of errors.
HairStrands decodeHair(std::span<const std::uint8_t> bytes, const std::filesystem::path& path,
                       const HairDefaults& defaults = {});

} // namespace strandlight
