// Reads OpenEXR pictures. Our own reader, because tinyexr 1.0.1 (which writes them) overruns its
// heap on broken PIZ data and leaks on others. It takes what we need: one part, scanlines, NONE,
// ZIPS or ZIP, half or float channels.
//
// Kainz, Bogart, Stanczyk. Technical Introduction to OpenEXR. 2013; OpenEXR File Layout.
#include "engine/base/image_io_formats.hpp"

#include <array>
#include <cstring>
#include <optional>

#include <glm/gtc/packing.hpp>

#include "engine/base/byte_stream.hpp"
#include "engine/base/image_io.hpp"

namespace strandlight {

namespace {

constexpr std::array<const char*, 10> kCompressionNames = {"NONE",  "RLE", "ZIPS", "ZIP",  "PIZ",
                                                           "PXR24", "B44", "B44A", "DWAA", "DWAB"};
enum Compression : std::uint8_t
{
    kNone = 0,
    kZips = 2,
    kZip = 3
};

struct Channel
{
    std::string name;
    std::int32_t type = 0; // 0 uint, 1 half, 2 float
    std::size_t bytes() const { return type == 1 ? 2 : 4; }
};

struct Header
{
    std::vector<Channel> channels;
    std::optional<std::uint8_t> compression;
    std::optional<std::array<std::int32_t, 4>> dataWindow; // xMin, yMin, xMax, yMax, inclusive
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::size_t rowBytes = 0;
    std::uint32_t rowsPerChunk() const { return compression == kZip ? 16 : 1; }
};

// Ends with a zero byte.
std::string readName(ByteReader& reader)
{
    std::string text;
    for (char c = reader.value<char>(); c != '\0'; c = reader.value<char>()) {
        text.push_back(c);
        if (text.size() > 255)
            reader.fail("a name has more than 255 characters");
    }
    return text;
}

std::vector<Channel> readChannels(std::span<const std::uint8_t> value, const std::string& name)
{
    ByteReader reader(value, name);
    std::vector<Channel> channels;
    for (std::string label = readName(reader); !label.empty(); label = readName(reader)) {
        Channel channel{label, reader.value<std::int32_t>()};
        reader.take(4); // pLinear and padding
        const auto xSampling = reader.value<std::int32_t>();
        const auto ySampling = reader.value<std::int32_t>();
        if (channel.type < 0 || channel.type > 2)
            reader.fail("channel " + label + " has the unknown type " +
                        std::to_string(channel.type));
        if (xSampling != 1 || ySampling != 1)
            reader.fail("channel " + label + " is subsampled, which is not supported");
        channels.push_back(std::move(channel));
    }
    return channels;
}

void readVersion(ByteReader& reader)
{
    if (reader.value<std::uint32_t>() != 20000630u)
        reader.fail("is not an OpenEXR picture (wrong magic number)");
    const auto version = reader.value<std::uint32_t>();
    if ((version & 0xFFu) != 2)
        reader.fail("has OpenEXR version " + std::to_string(version & 0xFFu) + ", only 2 is known");
    if (version & 0x200u)
        reader.fail("is tiled; only scanline pictures are supported");
    if (version & 0x800u)
        reader.fail("holds deep data, which is not supported");
    if (version & 0x1000u)
        reader.fail("has several parts; only one is supported");
}

// Refuses everything the decoder below does not handle, before anything is allocated for pixels.
void checkHeader(Header& header, const ByteReader& reader, const std::string& name)
{
    if (!header.compression || !header.dataWindow || header.channels.empty())
        reader.fail("the header lacks channels, compression or dataWindow");
    const std::uint8_t code = *header.compression;
    if (code != kNone && code != kZips && code != kZip)
        reader.fail("is compressed with " +
                    (code < kCompressionNames.size() ? kCompressionNames[code]
                                                     : "unknown method " + std::to_string(code)) +
                    "; only NONE, ZIPS and ZIP are supported: save it again with ZIP");
    const auto& window = *header.dataWindow;
    const std::int64_t width = std::int64_t(window[2]) - window[0] + 1;
    const std::int64_t height = std::int64_t(window[3]) - window[1] + 1;
    if (width <= 0 || height <= 0)
        reader.fail("the data window is empty");
    checkImageSize(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), name);
    header.width = static_cast<std::uint32_t>(width);
    header.height = static_cast<std::uint32_t>(height);
    for (const Channel& channel : header.channels)
        header.rowBytes += channel.bytes() * header.width;

    // Deflate shrinks at most 1032-fold, so a small file cannot ask for a large picture.
    const std::uint64_t most = std::uint64_t(reader.size()) * (code == kNone ? 1 : 1040);
    if (std::uint64_t(header.rowBytes) * header.height > most)
        reader.fail(std::to_string(reader.size()) + " bytes cannot hold " + std::to_string(width) +
                    " x " + std::to_string(height) + " pixels");
}

Header readHeader(ByteReader& reader, const std::string& name)
{
    readVersion(reader);
    Header header;
    for (std::string key = readName(reader); !key.empty(); key = readName(reader)) {
        const std::string type = readName(reader);
        const auto size = reader.value<std::int32_t>();
        if (size < 0)
            reader.fail("attribute " + key + " has a negative size");
        const auto value = reader.take(static_cast<std::size_t>(size));
        ByteReader attribute(value, name);
        if (key == "channels" && type == "chlist")
            header.channels = readChannels(value, name);
        else if (key == "compression" && type == "compression")
            header.compression = attribute.value<std::uint8_t>();
        else if (key == "dataWindow" && type == "box2i")
            header.dataWindow = attribute.value<std::array<std::int32_t, 4>>();
    }
    checkHeader(header, reader, name);
    return header;
}

// For each of R, G, B, A: which channel of the file, or -1. A lone Y is grey.
std::array<int, 4> mapChannels(const Header& header, const ByteReader& reader)
{
    const auto find = [&](const std::string& label) {
        for (std::size_t i = 0; i < header.channels.size(); ++i)
            if (header.channels[i].name == label && header.channels[i].type != 0)
                return static_cast<int>(i);
        return -1;
    };
    const int grey = find("Y");
    const std::array<int, 4> map = {find("R"), find("G"), find("B"), find("A")};
    if (map[0] >= 0 && map[1] >= 0 && map[2] >= 0)
        return map;
    if (grey >= 0)
        return {grey, grey, grey, map[3]};
    std::string labels;
    for (const Channel& channel : header.channels)
        labels += " " + channel.name;
    reader.fail("has no half or float channels R, G, B or Y, only:" + labels);
}

// ZIP stores byte differences, and first all even, then all odd bytes.
void undoPredictor(std::span<const std::uint8_t> coded, std::span<std::uint8_t> out)
{
    const std::size_t half = (coded.size() + 1) / 2;
    std::uint8_t value = 0;
    for (std::size_t i = 0; i < coded.size(); ++i) {
        value = static_cast<std::uint8_t>(i == 0 ? coded[0] : value + coded[i] - 128);
        out[i < half ? 2 * i : 2 * (i - half) + 1] = value;
    }
}

float readSample(const std::uint8_t* p, std::int32_t type)
{
    if (type == 1) {
        std::uint16_t bits = 0;
        std::memcpy(&bits, p, sizeof(bits));
        return glm::unpackHalf1x16(bits);
    }
    float value = 0.0f;
    std::memcpy(&value, p, sizeof(value));
    return value;
}

// One row as the file orders it: all of one channel, then the next.
void storeRow(const Header& header, const std::array<int, 4>& map, const std::uint8_t* row,
              std::span<glm::vec4> out)
{
    std::size_t start = 0;
    for (std::size_t i = 0; i < header.channels.size(); ++i) {
        const Channel& channel = header.channels[i];
        for (int target = 0; target < 4; ++target) {
            if (map[static_cast<std::size_t>(target)] != static_cast<int>(i))
                continue;
            for (std::size_t x = 0; x < out.size(); ++x)
                out[x][target] = readSample(row + start + x * channel.bytes(), channel.type);
        }
        start += channel.bytes() * out.size();
    }
}

// One block of rows from the file to `plain`; returns the index of its first row.
std::uint32_t readChunk(ByteReader& reader, const Header& header, std::vector<std::uint8_t>& plain)
{
    const std::int64_t y = std::int64_t(reader.value<std::int32_t>()) - (*header.dataWindow)[1];
    if (y < 0 || y >= header.height || y % header.rowsPerChunk() != 0)
        reader.fail("a block of rows starts at the impossible row " + std::to_string(y));
    const auto firstRow = static_cast<std::uint32_t>(y);
    const std::uint32_t rows = std::min(header.rowsPerChunk(), header.height - firstRow);
    const auto size = reader.value<std::int32_t>();
    plain.resize(header.rowBytes * rows);
    if (size < 0 || static_cast<std::size_t>(size) > plain.size())
        reader.fail("a block of " + std::to_string(plain.size()) + " bytes is stored in " +
                    std::to_string(size));
    const auto stored = reader.take(static_cast<std::size_t>(size));

    // Blocks that compression would enlarge are stored as they are.
    if (stored.size() == plain.size()) {
        std::memcpy(plain.data(), stored.data(), stored.size());
        return firstRow;
    }
    std::vector<std::uint8_t> coded(plain.size());
    if (header.compression == kNone || !inflateExactly(stored, coded))
        reader.fail("the rows from " + std::to_string(firstRow) + " on cannot be decompressed");
    undoPredictor(coded, plain);
    return firstRow;
}

} // namespace

CpuImage decodeExr(std::span<const std::uint8_t> bytes, const std::string& name)
{
    ByteReader reader(bytes, name);
    const Header header = readHeader(reader, name);
    const std::array<int, 4> map = mapChannels(header, reader);
    const std::uint32_t chunkCount =
        (header.height + header.rowsPerChunk() - 1) / header.rowsPerChunk();
    std::vector<std::uint64_t> offsets(chunkCount);
    for (std::uint64_t& offset : offsets)
        offset = reader.value<std::uint64_t>();

    CpuImage image(header.width, header.height, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    std::vector<bool> seen(chunkCount, false);
    std::vector<std::uint8_t> plain;
    for (const std::uint64_t offset : offsets) {
        reader.seek(offset);
        const std::uint32_t firstRow = readChunk(reader, header, plain);
        if (seen[firstRow / header.rowsPerChunk()])
            reader.fail("the rows from " + std::to_string(firstRow) + " on are stored twice");
        seen[firstRow / header.rowsPerChunk()] = true;
        const std::size_t rows = plain.size() / header.rowBytes;
        for (std::size_t r = 0; r < rows; ++r)
            storeRow(
                header, map, plain.data() + r * header.rowBytes,
                std::span(&image.at(0, firstRow + static_cast<std::uint32_t>(r)), header.width));
    }
    return image;
}

} // namespace strandlight
