// Pictures in and out. In memory all are linear fp32 (image.hpp); the 8-bit sRGB coding exists only
// in PNG and JPEG.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/base/image.hpp"

namespace strandlight {

// No picture is larger than this: a few bytes of a broken file must not allocate gigabytes.
inline constexpr std::uint32_t kMaximumImageSide = 16384;
inline constexpr std::uint64_t kMaximumImagePixels = std::uint64_t(1) << 26;

// An 8-bit picture as stored, whatever its colour space. rgba [height, width, 4], row 0 on top.
struct Image8
{
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba;
};

// PNG or JPEG bytes; missing alpha is 255. `name` is the file or "file, image 3" for messages.
// Throws FileError for anything else, for broken data and for pictures over the limits above.
Image8 decodeImage8(std::span<const std::uint8_t> bytes, const std::string& name);

// By suffix: .png, .jpg (sRGB decoded to linear), .hdr (Radiance RGBE), .exr (one part, scanlines,
// stored raw or by ZIP/ZIPS, half or float channels R G B [A] or Y; its data window). Non-finite
// values are kept. Throws FileError.
CpuImage loadImage(const std::filesystem::path& path);

// Linear RGB clamped to [0,1], sRGB coded, 8 bits, rounded to nearest; alpha is not stored.
// Non-finite pixels become magenta and are counted in a warning.
std::vector<std::uint8_t> encodePng(const CpuImage& image);
void savePng(const std::filesystem::path& path, const CpuImage& image);

// R, G, B as fp32, ZIP scanlines: loads back bit for bit. Alpha is not stored.
void saveExr(const std::filesystem::path& path, const CpuImage& image);

// By suffix: .png or .exr. Throws Error for any other.
void saveImage(const std::filesystem::path& path, const CpuImage& image);

// IEC 61966-2-1, one channel. `encodeSrgb` expects a value in [0,1].
float decodeSrgb(float coded);
float encodeSrgb(float linear);

} // namespace strandlight
