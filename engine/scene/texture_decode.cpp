#include "engine/scene/texture_decode.hpp"

#include <cstring>

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

std::uint64_t bigEndian(const std::uint8_t* bytes, int count)
{
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i)
        value = value << 8 | bytes[i];
    return value;
}

struct Size
{
    std::uint64_t width = 0;
    std::uint64_t height = 0;
};

// From the first frame header (SOF0 to SOF15 but for the tables DHT, JPG and DAC); zero when there
// is none.
Size jpegSize(std::span<const std::uint8_t> bytes)
{
    for (std::size_t i = 2; i + 9 <= bytes.size();) {
        if (bytes[i] != 0xff)
            return {};
        const std::uint8_t marker = bytes[i + 1];
        const bool frame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (frame)
            return {bigEndian(&bytes[i + 7], 2), bigEndian(&bytes[i + 5], 2)};
        i += marker == 0xff ? 1 : 2 + bigEndian(&bytes[i + 2], 2);
    }
    return {};
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

} // namespace

Image8 decodeTexture(std::span<const std::uint8_t> bytes, const std::string& name)
{
    const bool png = isPng(bytes);
    if (!png && !isJpeg(bytes))
        throw FileError(name, "", "the image is neither PNG nor JPEG");
    const Size size =
        png ? Size{bigEndian(&bytes[16], 4), bigEndian(&bytes[20], 4)} : jpegSize(bytes);
    const std::string sizeText = std::to_string(size.width) + " x " + std::to_string(size.height);
    if (size.width > kMaximumImageSide || size.height > kMaximumImageSide)
        throw FileError(name, "",
                        "a texture of " + sizeText + " texels; the limit is " +
                            std::to_string(kMaximumImageSide) + " a side");
    // Deflate packs at most 1032 to 1, and a PNG texel has at least one bit; a JPEG needs at least
    // one bit for each of the six blocks of a 16 x 16 square. Fewer bytes cannot hold the picture.
    const std::uint64_t texelsPerByte = png ? 8 * 1032 : 512;
    if (size.width * size.height > texelsPerByte * bytes.size())
        throw FileError(name, "",
                        "truncated: " + std::to_string(bytes.size()) + " bytes cannot hold " +
                            sizeText + " texels");
    // The decoder shows a cut JPEG as far as it goes; the end marker tells.
    if (!png && lastMarker(bytes, 0xd9) <= lastMarker(bytes, 0xda))
        throw FileError(name, "", "truncated: the JPEG has no end marker");
    return decodeImage8(bytes, name);
}

} // namespace strandlight
