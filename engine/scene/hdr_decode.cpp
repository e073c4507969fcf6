// A strict reader: stb_image shows truncated files as far as it understands them, and takes seconds
// over claims of sizes that the bytes cannot hold.

#include <charconv>
#include <cmath>
#include <string_view>

#include "engine/base/error.hpp"
#include "engine/scene/image_decode.hpp"

namespace strandlight {

namespace {

class HdrReader
{
public:
    HdrReader(std::span<const std::uint8_t> bytes, const std::filesystem::path& path)
        : bytes_(bytes), path_(path)
    {
    }

    CpuImage read();

private:
    [[noreturn]] void fail(const std::string& reason) const
    {
        throw FileError(path_.string(), "byte " + std::to_string(position_), reason);
    }

    std::uint8_t byte()
    {
        if (position_ >= bytes_.size())
            fail("truncated");
        return bytes_[position_++];
    }

    std::string line();
    void readHeader();
    void readSize();
    void readRow(std::vector<std::uint8_t>& row); // [4, width]
    void readRun(std::uint8_t* channel);

    std::span<const std::uint8_t> bytes_;
    const std::filesystem::path& path_;
    std::size_t position_ = 0;
    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
};

std::string HdrReader::line()
{
    std::string text;
    for (std::uint8_t c = byte(); c != '\n'; c = byte()) {
        if (text.size() >= 1024)
            fail("a header line has no end");
        text.push_back(static_cast<char>(c));
    }
    return text;
}

void HdrReader::readHeader()
{
    const std::string magic = line();
    if (magic != "#?RADIANCE" && magic != "#?RGBE")
        fail("not a Radiance HDR file");
    bool rgbe = false;
    for (std::string text = line(); !text.empty(); text = line())
        rgbe = rgbe || text == "FORMAT=32-bit_rle_rgbe";
    if (!rgbe)
        fail("only FORMAT=32-bit_rle_rgbe is supported");
    readSize();
}

// "-Y <height> +X <width>"
void HdrReader::readSize()
{
    const std::string text = line();
    const std::size_t middle = text.find(" +X ");
    if (!text.starts_with("-Y ") || middle == std::string::npos)
        fail("'" + text + "' is not a size in the order -Y +X");
    const auto number = [&](std::size_t first, std::size_t last, std::uint32_t& value) {
        const auto [end, error] = std::from_chars(text.data() + first, text.data() + last, value);
        if (error != std::errc() || end != text.data() + last || value == 0)
            fail("'" + text + "' is not a size");
    };
    number(3, middle, height_);
    number(middle + 4, text.size(), width_);
    if (width_ > kMaximumTextureSide || height_ > kMaximumTextureSide)
        fail("environment of " + std::to_string(width_) + " x " + std::to_string(height_) +
             ", the limit is " + std::to_string(kMaximumTextureSide) + " a side");
    // The best a row can do is runs of 127 texels in two bytes, four channels, behind a mark of
    // four bytes.
    const std::uint64_t smallestRow =
        width_ < 8 ? 4 * width_ : 4 + 8 * ((std::uint64_t(width_) + 126) / 127);
    if (smallestRow * height_ > bytes_.size() - position_)
        fail("truncated: " + std::to_string(bytes_.size() - position_) + " bytes cannot hold " +
             std::to_string(width_) + " x " + std::to_string(height_) + " texels");
}

void HdrReader::readRun(std::uint8_t* channel)
{
    for (std::uint32_t x = 0; x < width_;) {
        std::uint32_t count = byte();
        const bool run = count > 128;
        count -= run ? 128u : 0u;
        if (count == 0 || count > width_ - x)
            fail("a run of " + std::to_string(count) + " texels leaves the row");
        const std::uint8_t value = run ? byte() : std::uint8_t(0);
        for (std::uint32_t i = 0; i < count; ++i)
            channel[x++] = run ? value : byte();
    }
}

void HdrReader::readRow(std::vector<std::uint8_t>& row)
{
    const std::uint8_t first[4] = {byte(), byte(), byte(), byte()};
    const bool encoded = width_ >= 8 && first[0] == 2 && first[1] == 2 && first[2] < 128;
    if (!encoded) {
        // A flat row of RGBE texels. (The run marker 1,1,1,n of before 1991 is refused below.)
        for (std::uint32_t x = 0; x < width_; ++x) {
            for (std::uint32_t c = 0; c < 4; ++c)
                row[c * width_ + x] = x == 0 ? first[c] : byte();
            if (row[x] == 1 && row[width_ + x] == 1 && row[2 * width_ + x] == 1)
                fail("old run-length encoding is not supported");
        }
        return;
    }
    if ((std::uint32_t(first[2]) << 8 | first[3]) != width_)
        fail("a row of another width");
    for (std::uint32_t c = 0; c < 4; ++c)
        readRun(row.data() + c * width_);
}

CpuImage HdrReader::read()
{
    readHeader();
    CpuImage image(width_, height_);
    std::vector<std::uint8_t> row(std::size_t(width_) * 4);
    for (std::uint32_t y = 0; y < height_; ++y) {
        readRow(row);
        for (std::uint32_t x = 0; x < width_; ++x) {
            const int exponent = row[3 * width_ + x];
            const float scale = exponent == 0 ? 0.0f : std::ldexp(1.0f, exponent - 136);
            image.at(x, y) = glm::vec4(float(row[x]) * scale, float(row[width_ + x]) * scale,
                                       float(row[2 * width_ + x]) * scale, 1.0f);
        }
    }
    return image;
}

} // namespace

CpuImage decodeRadianceHdr(std::span<const std::uint8_t> bytes, const std::filesystem::path& path)
{
    return HdrReader(bytes, path).read();
}

} // namespace strandlight
