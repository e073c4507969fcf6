// Radiance pictures (.hdr): RGBE pixels, flat or run-length coded.
// Ward. Real Pixels. Graphics Gems II. 1991; the Radiance file format reference.
#include "engine/base/image_io_formats.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "engine/base/error.hpp"
#include "engine/base/image_io.hpp"

namespace strandlight {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

class HdrReader
{
public:
    HdrReader(std::span<const std::uint8_t> bytes, const std::string& name)
        : bytes_(bytes), name_(name)
    {
    }

    [[noreturn]] void fail(const std::string& reason) const
    {
        throw FileError(name_, "byte " + std::to_string(position_), reason);
    }

    std::uint8_t next()
    {
        if (position_ >= bytes_.size())
            fail("the file ends inside the picture");
        return bytes_[position_++];
    }

    std::string_view line()
    {
        const auto rest = bytes_.subspan(position_);
        const auto end = std::find(rest.begin(), rest.end(), std::uint8_t('\n'));
        if (end == rest.end())
            fail("the file ends inside the header");
        std::string_view text(reinterpret_cast<const char*>(rest.data()),
                              static_cast<std::size_t>(end - rest.begin()));
        position_ += text.size() + 1;
        if (!text.empty() && text.back() == '\r')
            text.remove_suffix(1);
        return text;
    }

    std::size_t remaining() const { return bytes_.size() - position_; }

    void readScanline(std::span<Rgbe> row);

private:
    void readRunLengthChannels(std::span<Rgbe> row);
    void readFlat(std::span<Rgbe> row, std::uint32_t already);

    std::span<const std::uint8_t> bytes_;
    const std::string& name_;
    std::size_t position_ = 0;
};

// The four channels one after another; a count above 128 is a run, else literal bytes.
void HdrReader::readRunLengthChannels(std::span<Rgbe> row)
{
    for (std::size_t channel = 0; channel < 4; ++channel) {
        for (std::size_t x = 0; x < row.size();) {
            const std::uint8_t code = next();
            const std::size_t count = code > 128 ? code - 128u : code;
            if (count == 0 || count > row.size() - x)
                fail("a run of " + std::to_string(count) + " does not fit its row");
            std::uint8_t value = code > 128 ? next() : std::uint8_t(0);
            for (std::size_t i = 0; i < count; ++i, ++x) {
                if (code <= 128)
                    value = next();
                row[x][channel] = value;
            }
        }
    }
}

// Plain pixels; (1, 1, 1, n) repeats the last pixel n times, and successive ones count in base 256.
void HdrReader::readFlat(std::span<Rgbe> row, std::uint32_t already)
{
    std::uint32_t shift = 0;
    for (std::size_t x = already; x < row.size();) {
        const Rgbe pixel{next(), next(), next(), next()};
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            row[x++] = pixel;
            shift = 0;
            continue;
        }
        const std::uint64_t count = std::uint64_t(pixel[3]) << shift;
        if (x == 0 || shift > 16 || count > row.size() - x)
            fail("a repetition of " + std::to_string(count) + " does not fit its row");
        for (std::uint64_t i = 0; i < count; ++i, ++x)
            row[x] = row[x - 1];
        shift += 8;
    }
}

void HdrReader::readScanline(std::span<Rgbe> row)
{
    const Rgbe first{next(), next(), next(), next()};
    const bool runLength = first[0] == 2 && first[1] == 2 && first[2] < 128 && row.size() >= 8;
    if (!runLength) {
        row[0] = first;
        readFlat(row, 1);
        return;
    }
    const std::size_t width = std::size_t(first[2]) << 8 | first[3];
    if (width != row.size())
        fail("a row claims " + std::to_string(width) + " pixels, the header " +
             std::to_string(row.size()));
    readRunLengthChannels(row);
}

std::uint64_t parseCount(std::string_view& text, const HdrReader& reader)
{
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc())
        reader.fail("a number is expected in the resolution line");
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

// Only the usual order: rows from the top, pixels from the left.
std::pair<std::uint64_t, std::uint64_t> parseResolution(std::string_view line,
                                                        const HdrReader& reader)
{
    constexpr std::string_view kRows = "-Y ";
    constexpr std::string_view kColumns = " +X ";
    if (!line.starts_with(kRows))
        reader.fail("the resolution line is not \"-Y height +X width\"");
    line.remove_prefix(kRows.size());
    const std::uint64_t height = parseCount(line, reader);
    if (!line.starts_with(kColumns))
        reader.fail("the resolution line is not \"-Y height +X width\"");
    line.remove_prefix(kColumns.size());
    return {parseCount(line, reader), height};
}

// Radiance of a pixel: mantissa / 256 * 2^(exponent - 128).
glm::vec4 decodeRgbe(const Rgbe& p)
{
    if (p[3] == 0)
        return {0.0f, 0.0f, 0.0f, 1.0f};
    const float scale = std::ldexp(1.0f, p[3] - 136);
    return {p[0] * scale, p[1] * scale, p[2] * scale, 1.0f};
}

} // namespace

CpuImage decodeHdr(std::span<const std::uint8_t> bytes, const std::string& name)
{
    HdrReader reader(bytes, name);
    if (!reader.line().starts_with("#?"))
        throw FileError(name, "byte 0", "is not a Radiance picture (no \"#?\" at its start)");
    bool isRgbe = false;
    for (std::string_view line = reader.line(); !line.empty(); line = reader.line())
        isRgbe = isRgbe || line == "FORMAT=32-bit_rle_rgbe";
    if (!isRgbe)
        reader.fail("the header has no FORMAT=32-bit_rle_rgbe; other codings are not supported");
    const auto [width, height] = parseResolution(reader.line(), reader);
    checkImageSize(width, height, name);

    // A full run of 127 pixels takes two bytes in each of four channels; less cannot describe the
    // rows.
    const std::uint64_t leastBytes = height * (4 + 8 * (width / 128));
    if (reader.remaining() < leastBytes)
        reader.fail("holds " + std::to_string(reader.remaining()) + " bytes of pixels, " +
                    std::to_string(width) + " x " + std::to_string(height) + " needs at least " +
                    std::to_string(leastBytes));

    CpuImage image(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
    std::vector<Rgbe> row(width);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        reader.readScanline(row);
        for (std::uint32_t x = 0; x < image.width; ++x)
            image.at(x, y) = decodeRgbe(row[x]);
    }
    return image;
}

} // namespace strandlight
