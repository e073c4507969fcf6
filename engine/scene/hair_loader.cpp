// AMD. TressFX 4.0, file format "tfx". 2017. Cem Yuksel. HAIR model files. 2010.
#include "engine/scene/hair_loader.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/base/byte_stream.hpp"
#include "engine/base/error.hpp"
#include "engine/base/file.hpp"

namespace strandlight {

namespace {

constexpr float kLargestCoordinate = 1e6f; // metres: beyond it fp32 does not resolve a hair

// The head of a .tfx file, 160 bytes. Offsets of 0 mean absent.
struct TfxHeader
{
    float version;
    std::uint32_t strands;
    std::uint32_t pointsPerStrand;
    std::uint32_t positions; // offset of float4 [strands, pointsPerStrand]
    std::uint32_t strandUvs;
    std::uint32_t vertexUvs;
    std::uint32_t strandThickness;
    std::uint32_t vertexColors;
    std::uint32_t reserved[32];
};
static_assert(sizeof(TfxHeader) == 160);

// The head of a .hair file, 128 bytes. The arrays follow in the order of their flags.
struct HairHeader
{
    char magic[4];
    std::uint32_t strands;
    std::uint32_t points;
    std::uint32_t flags;
    std::uint32_t segments; // per strand, without an array of them
    float thickness;        // diameter
    float transparency;
    float color[3];
    char info[88];
};
static_assert(sizeof(HairHeader) == 128);

enum HairFlag : std::uint32_t
{
    kHasSegments = 1,     // u16 [strands]
    kHasPoints = 2,       // float3 [points]
    kHasThickness = 4,    // float [points]
    kHasTransparency = 8, // float [points]
    kHasColors = 16,      // float3 [points]
    kKnownFlags = 31
};

// One file on its way in.
struct Source
{
    std::string path;
    std::span<const std::uint8_t> bytes;
    const HairDefaults& defaults;

    [[noreturn]] void fail(const std::string& place, const std::string& reason) const
    {
        throw FileError(path, place, reason);
    }
};

std::string pointName(std::size_t i)
{
    return "point " + std::to_string(i);
}

void checkPositions(const Source& source, const std::vector<glm::vec3>& points)
{
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(points[i][axis]) <= kLargestCoordinate)) // true for NaN
                source.fail(pointName(i), "the coordinate " + std::to_string(points[i][axis]) +
                                              " is not finite or beyond 1e6");
}

void checkRange(const Source& source, const char* what, float value, float high,
                const std::string& place)
{
    if (!(value >= 0.0f && value <= high)) // true for NaN
        source.fail(place, std::string(what) + " of " + std::to_string(value) +
                               " is outside of 0 .. " + std::to_string(high));
}

// One diameter for all strands, tapered at the tips.
void useDiameter(HairStrands& hair, float diameter)
{
    hair.radii.resize(hair.points.size());
    for (std::uint32_t s = 0; s < hair.strandCount(); ++s) {
        const std::uint32_t first = hair.firstPoint[s];
        const std::uint32_t last = hair.firstPoint[s + 1] - 1;
        for (std::uint32_t i = first; i <= last; ++i)
            hair.radii[i] =
                0.5f * diameter *
                tipTaper(static_cast<float>(i - first) / static_cast<float>(last - first));
    }
}

float defaultDiameter(const Source& source, const HairStrands& hair)
{
    return source.defaults.diameterOfExtent * glm::length(hair.boundsMax() - hair.boundsMin());
}

HairStrands readTfx(const Source& source)
{
    ByteReader reader(source.bytes, source.path);
    const auto header = reader.value<TfxHeader>();
    if (!(header.version >= 4.0f && header.version < 5.0f))
        source.fail("byte 0", "version " + std::to_string(header.version) + " is not TressFX 4");
    if (header.strands == 0 || header.pointsPerStrand < 2)
        source.fail("byte 4", std::to_string(header.strands) + " strands of " +
                                  std::to_string(header.pointsPerStrand) +
                                  " points: at least 1 of 2 is needed");
    const std::uint64_t size = source.bytes.size();
    const std::uint64_t strandBytes = std::uint64_t(header.pointsPerStrand) * sizeof(glm::vec4);
    if (header.positions < sizeof(TfxHeader) || header.positions > size ||
        header.strands > (size - header.positions) / strandBytes) // u64, and before any allocation
        source.fail("byte 12", std::to_string(header.strands) + " strands of " +
                                   std::to_string(header.pointsPerStrand) + " points at byte " +
                                   std::to_string(header.positions) + " do not fit into " +
                                   std::to_string(size) + " bytes");

    const std::uint64_t count = std::uint64_t(header.strands) * header.pointsPerStrand;
    HairStrands hair;
    hair.points.resize(count);
    for (std::uint64_t i = 0; i < count; ++i) // w is the inverse mass of a simulation
        std::memcpy(&hair.points[i], source.bytes.data() + header.positions + i * sizeof(glm::vec4),
                    sizeof(glm::vec3));
    for (std::uint64_t first = 0; first <= count; first += header.pointsPerStrand)
        hair.firstPoint.push_back(static_cast<std::uint32_t>(first));
    checkPositions(source, hair.points);
    useDiameter(hair, defaultDiameter(source, hair));
    paintHair(hair, source.defaults.color, source.defaults.colorVariation, source.defaults.seed);
    return hair;
}

// `count` elements of a flagged array, checked against what is left before anything is allocated.
template <class T> std::vector<T> readArray(ByteReader& reader, std::uint64_t count)
{
    if (count > reader.left() / sizeof(T))
        reader.fail(std::to_string(count) + " elements are claimed, " +
                    std::to_string(reader.left()) + " bytes are left");
    std::vector<T> values(count);
    for (T& value : values)
        value = reader.value<T>();
    return values;
}

void checkHeader(const Source& source, const HairHeader& header)
{
    if (header.strands == 0)
        source.fail("byte 4", "no strand");
    if (!(header.flags & kHasPoints))
        source.fail("byte 12", "no array of points");
    if (header.flags & ~std::uint32_t(kKnownFlags))
        source.fail("byte 12",
                    "unknown flags " + std::to_string(header.flags & ~std::uint32_t(kKnownFlags)));
    checkRange(source, "a thickness", header.thickness, kLargestCoordinate, "byte 20");
    checkRange(source, "a transparency", header.transparency, 1.0f, "byte 24");
    for (const float c : header.color)
        checkRange(source, "a colour", c, 1.0f, "byte 28");
}

// firstPoint, after the segments of each strand were checked against the number of points.
std::vector<std::uint32_t> readStrands(const Source& source, ByteReader& reader,
                                       const HairHeader& header)
{
    const bool hasArray = header.flags & kHasSegments;
    std::vector<std::uint16_t> segments;
    if (hasArray)
        segments = readArray<std::uint16_t>(reader, header.strands);
    else if (std::uint64_t(header.strands) * (std::uint64_t(header.segments) + 1) != header.points)
        source.fail("byte 4", std::to_string(header.strands) + " strands of " +
                                  std::to_string(header.segments) + " segments do not have " +
                                  std::to_string(header.points) + " points");
    if (header.points > reader.left() / sizeof(glm::vec3)) // bounds the strands as well
        reader.fail(std::to_string(header.points) + " points are claimed, " +
                    std::to_string(reader.left()) + " bytes are left");
    std::vector<std::uint32_t> firstPoint{0};
    std::uint64_t points = 0;
    for (std::uint64_t s = 0; s < header.strands; ++s) {
        const std::uint64_t count = hasArray ? segments[s] : header.segments;
        if (count == 0)
            source.fail("strand " + std::to_string(s), "no segment");
        points += count + 1;
        if (points > header.points)
            break; // reported below
        firstPoint.push_back(static_cast<std::uint32_t>(points));
    }
    if (points != header.points)
        source.fail("byte 8",
                    "the strands do not have " + std::to_string(header.points) + " points");
    return firstPoint;
}

void readThickness(const Source& source, ByteReader& reader, const HairHeader& header,
                   HairStrands& hair)
{
    if (!(header.flags & kHasThickness)) {
        const bool given = header.thickness > 0.0f;
        useDiameter(hair, given ? header.thickness : defaultDiameter(source, hair));
        return;
    }
    hair.radii = readArray<float>(reader, header.points);
    for (std::size_t i = 0; i < hair.radii.size(); ++i) {
        checkRange(source, "a thickness", hair.radii[i], kLargestCoordinate, pointName(i));
        hair.radii[i] *= 0.5f;
    }
}

HairStrands readHair(const Source& source)
{
    ByteReader reader(source.bytes, source.path);
    const auto header = reader.value<HairHeader>();
    checkHeader(source, header);
    HairStrands hair;
    hair.firstPoint = readStrands(source, reader, header);
    hair.points = readArray<glm::vec3>(reader, header.points);
    checkPositions(source, hair.points);
    readThickness(source, reader, header, hair);
    if (header.flags & kHasTransparency) {
        const auto values = readArray<float>(reader, header.points);
        for (std::size_t i = 0; i < values.size(); ++i)
            checkRange(source, "a transparency", values[i], 1.0f, pointName(i));
    }
    if (header.flags & kHasColors) {
        hair.colors = readArray<glm::vec3>(reader, header.points);
        for (std::size_t i = 0; i < hair.colors.size(); ++i)
            for (int c = 0; c < 3; ++c)
                checkRange(source, "a colour", hair.colors[i][c], 1.0f, pointName(i));
    } else {
        const glm::vec3 color(header.color[0], header.color[1], header.color[2]);
        paintHair(hair, color, source.defaults.colorVariation, source.defaults.seed);
    }
    return hair;
}

} // namespace

HairStrands loadHair(const std::filesystem::path& path, const HairDefaults& defaults)
{
    return decodeHair(readFile(path), path, defaults);
}

HairStrands decodeHair(std::span<const std::uint8_t> bytes, const std::filesystem::path& path,
                       const HairDefaults& defaults)
{
    const Source source{path.string(), bytes, defaults};
    HairStrands hair;
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "HAIR", 4) == 0)
        hair = readHair(source);
    else if (path.extension() == ".tfx")
        hair = readTfx(source);
    else
        source.fail("byte 0", "is neither a .hair file (\"HAIR\") nor named .tfx");
    hair.name = path.stem().string();
    return hair;
}

} // namespace strandlight
