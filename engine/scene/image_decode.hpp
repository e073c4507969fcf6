// Encoded pictures to texels, with every claim of the file checked before memory is taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/base/image.hpp"

namespace strandlight {

inline constexpr std::uint32_t kMaximumTextureSide = 16384;

struct Rgba8Image
{
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba; // [height, width, 4]
};

// PNG or JPEG. Throws FileError for other formats, sides above kMaximumTextureSide, more than
// `maximumBytes` of texels, truncated or damaged files.
Rgba8Image decodePngOrJpeg(std::span<const std::uint8_t> bytes, std::uint64_t maximumBytes,
                           const std::filesystem::path& path, const std::string& place);

// Radiance HDR (RGBE, run-length encoded or flat, -Y +X order). alpha is 1. Throws FileError.
// Ward. Real Pixels. Graphics Gems II. 1991
CpuImage decodeRadianceHdr(std::span<const std::uint8_t> bytes, const std::filesystem::path& path);

} // namespace strandlight
