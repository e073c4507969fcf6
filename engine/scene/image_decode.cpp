#include "engine/scene/image_decode.hpp"

#include <algorithm>
#include <cstring>
#include <memory>

// A private copy with two formats only: the rest of stb_image is attack surface without a use.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#include <stb/stb_image.h>

#include "engine/base/error.hpp"

namespace strandlight {

namespace {

bool isPng(std::span<const std::uint8_t> bytes)
{
    static constexpr std::uint8_t kMagic[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    return bytes.size() >= 24 && std::memcmp(bytes.data(), kMagic, 8) == 0;
}

bool isJpeg(std::span<const std::uint8_t> bytes)
{
    return bytes.size() >= 4 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

// Offset behind the last marker of a kind, 0 when there is none.
std::size_t lastMarker(std::span<const std::uint8_t> bytes, std::uint8_t marker)
{
    for (std::size_t i = bytes.size(); i >= 2; --i) {
        if (bytes[i - 2] == 0xff && bytes[i - 1] == marker)
            return i;
    }
    return 0;
}

std::uint32_t bigEndian32(const std::uint8_t* bytes)
{
    return std::uint32_t(bytes[0]) << 24 | std::uint32_t(bytes[1]) << 16 |
           std::uint32_t(bytes[2]) << 8 | std::uint32_t(bytes[3]);
}

std::string sizeText(std::uint64_t width, std::uint64_t height)
{
    return std::to_string(width) + " x " + std::to_string(height);
}

} // namespace

Rgba8Image decodePngOrJpeg(std::span<const std::uint8_t> bytes, std::uint64_t maximumBytes,
                           const std::filesystem::path& path, const std::string& place)
{
    const auto fail = [&](const std::string& reason) {
        throw FileError(path.string(), place, reason);
    };
    const bool png = isPng(bytes);
    if (!png && !isJpeg(bytes))
        fail("the image is neither PNG nor JPEG");
    if (bytes.size() > std::size_t(INT32_MAX))
        fail("the image file is larger than 2 GiB");
    const int size = static_cast<int>(bytes.size());

    // stb_image refuses large sides without saying how large: PNG keeps them in the first chunk.
    const auto checkSides = [&](std::uint64_t width, std::uint64_t height) {
        if (width > kMaximumTextureSide || height > kMaximumTextureSide)
            fail("texture of " + sizeText(width, height) + " texels, the limit is " +
                 sizeText(kMaximumTextureSide, kMaximumTextureSide));
        if (width * height * 4 > maximumBytes)
            fail("texture of " + sizeText(width, height) +
                 " texels: the scene's textures together exceed the memory limit");
    };
    if (png)
        checkSides(bigEndian32(bytes.data() + 16), bigEndian32(bytes.data() + 20));
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0 || width <= 0 ||
        height <= 0)
        fail(std::string("damaged image header: ") + stbi_failure_reason());
    checkSides(std::uint64_t(width), std::uint64_t(height));

    // Deflate packs at most 1032 to 1, and a PNG texel has at least one bit; a JPEG needs at least
    // one bit for each of the six blocks of a 16 x 16 square. Fewer bytes cannot hold the picture:
    // do not take memory for it.
    const std::uint64_t texelsPerByte = png ? 8 * 1032 : 512;
    if (std::uint64_t(width) * std::uint64_t(height) > texelsPerByte * bytes.size())
        fail("truncated: " + std::to_string(bytes.size()) + " bytes cannot hold " +
             sizeText(std::uint64_t(width), std::uint64_t(height)) + " texels");
    // stb_image shows a cut JPEG as far as it goes; the end marker tells.
    if (!png && lastMarker(bytes, 0xd9) <= lastMarker(bytes, 0xda))
        fail("truncated: the JPEG has no end marker");

    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
    if (!pixels)
        fail(std::string("damaged image: ") + stbi_failure_reason());
    Rgba8Image image;
    image.width = static_cast<std::uint32_t>(width);
    image.height = static_cast<std::uint32_t>(height);
    image.rgba.assign(pixels.get(), pixels.get() + std::size_t(width) * std::size_t(height) * 4);
    return image;
}

} // namespace strandlight
