#include "passes/sgl_chunks.hpp"

#include <cmath>

#include "engine/base/error.hpp"

namespace strandlight {

namespace {

constexpr std::uint32_t kLongestText = 4096;
constexpr std::uint32_t kMaximumResolution = 4096;
constexpr std::uint64_t kCornerBytes = 20;
constexpr std::uint64_t kTexelBytes = 20;

float readFinite(ByteReader& reader, const char* what)
{
    const auto value = reader.value<float>();
    if (!std::isfinite(value))
        reader.fail(std::string(what) + " is not finite");
    return value;
}

void expectBytes(const ByteReader& reader, std::uint64_t count, std::uint64_t each)
{
    // Divided, not multiplied: a broken count must not overflow.
    if (reader.left() % each != 0 || reader.left() / each != count)
        reader.fail("has " + std::to_string(reader.left()) + " bytes for " + std::to_string(count) +
                    " entries of " + std::to_string(each));
}

// u32 tile size, then a mask for each tile, of as many bytes as the lobes have bits.
void encodeMasks(const SgField& field, const Atlas& atlas, ByteWriter& writer)
{
    writer.value(field.tileSize);
    if (field.tileSize == 0)
        return;
    const LobeTiles tiles = lobeTiles(atlas, field.tileSize);
    std::vector<std::uint32_t> masks(tiles.count, 0);
    for (std::size_t t = 0; t < field.kept.size(); ++t)
        masks[tiles.tileOf[t]] = field.kept[t];
    for (std::size_t t = 0; t < field.kept.size(); ++t)
        if (masks[tiles.tileOf[t]] != field.kept[t] || (field.kept[t] & ~field.allLobes()) != 0u)
            throw Error("cannot store texel " + std::to_string(t) +
                        ": it keeps other lobes than its tile");
    for (const std::uint32_t mask : masks)
        for (std::size_t byte = 0; byte < sglMaskBytes(field.lobeCount); ++byte)
            writer.value(static_cast<std::uint8_t>(mask >> (8 * byte)));
}

void decodeMasks(ByteReader& reader, const Atlas& atlas, SgField& field)
{
    field.tileSize = reader.value<std::uint32_t>();
    if (field.tileSize > kMaximumResolution)
        reader.fail("claims tiles of " + std::to_string(field.tileSize) + " texels a side");
    if (field.tileSize == 0)
        return;
    const LobeTiles tiles = lobeTiles(atlas, field.tileSize);
    std::vector<std::uint32_t> masks(tiles.count, 0);
    for (std::uint32_t& mask : masks) {
        for (std::size_t byte = 0; byte < sglMaskBytes(field.lobeCount); ++byte)
            mask |= std::uint32_t(reader.value<std::uint8_t>()) << (8 * byte);
        if ((mask & ~field.allLobes()) != 0u)
            reader.fail("a tile keeps lobes that are not there");
    }
    field.kept.reserve(tiles.tileOf.size());
    for (const std::uint32_t tile : tiles.tileOf)
        field.kept.push_back(masks[tile]);
}

} // namespace

std::vector<std::uint8_t> encodeInfo(const BakeInfo& info)
{
    ByteWriter writer;
    writer.text(info.scene.substr(0, kLongestText));
    writer.text(info.fitMode.substr(0, kLongestText));
    writer.value(info.geometryHash);
    writer.value(info.environmentHash);
    writer.value(info.lightfieldSize);
    writer.value(info.samplesPerDirection);
    writer.value(info.bounces);
    writer.value(info.steps);
    writer.value(info.seed);
    writer.value(info.rmse);
    return writer.take();
}

BakeInfo decodeInfo(ByteReader reader)
{
    BakeInfo info;
    info.scene = reader.text(kLongestText);
    info.fitMode = reader.text(kLongestText);
    info.geometryHash = reader.value<std::uint64_t>();
    info.environmentHash = reader.value<std::uint64_t>();
    info.lightfieldSize = reader.value<std::uint32_t>();
    info.samplesPerDirection = reader.value<std::uint32_t>();
    info.bounces = reader.value<std::uint32_t>();
    info.steps = reader.value<std::uint32_t>();
    info.seed = reader.value<std::uint32_t>();
    info.rmse = readFinite(reader, "rmse");
    reader.finish();
    return info;
}

std::vector<std::uint8_t> encodeAtlasSizes(const Atlas& atlas)
{
    ByteWriter writer;
    writer.value(atlas.resolution);
    writer.value(atlas.chartCount);
    writer.value(static_cast<std::uint32_t>(atlas.usedTexCoord1));
    writer.value(atlas.texelsPerMetre);
    writer.value(static_cast<std::uint64_t>(atlas.corners.size()));
    writer.value(static_cast<std::uint64_t>(atlas.texels.size()));
    return writer.take();
}

Atlas decodeAtlasSizes(ByteReader reader, std::uint64_t& cornerCount, std::uint64_t& texelCount)
{
    Atlas atlas;
    atlas.resolution = reader.value<std::uint32_t>();
    atlas.chartCount = reader.value<std::uint32_t>();
    const auto used = reader.value<std::uint32_t>();
    atlas.usedTexCoord1 = used != 0;
    atlas.texelsPerMetre = readFinite(reader, "texels per metre");
    cornerCount = reader.value<std::uint64_t>();
    texelCount = reader.value<std::uint64_t>();
    reader.finish();
    if (atlas.resolution == 0 || atlas.resolution > kMaximumResolution || used > 1 ||
        cornerCount % 3 != 0 || texelCount > std::uint64_t(atlas.resolution) * atlas.resolution)
        reader.fail("the sizes are impossible: resolution " + std::to_string(atlas.resolution) +
                    ", " + std::to_string(cornerCount) + " corners, " + std::to_string(texelCount) +
                    " texels");
    return atlas;
}

std::vector<std::uint8_t> encodeCorners(const Atlas& atlas)
{
    ByteWriter writer;
    for (const AtlasCorner& corner : atlas.corners)
        for (const float value :
             {corner.uv.x, corner.uv.y, corner.tangent.x, corner.tangent.y, corner.tangent.z})
            writer.value(value);
    return writer.take();
}

void decodeCorners(ByteReader reader, std::uint64_t count, Atlas& atlas)
{
    expectBytes(reader, count, kCornerBytes);
    const auto side = static_cast<float>(atlas.resolution);
    atlas.corners.resize(count);
    for (AtlasCorner& corner : atlas.corners) {
        for (int i = 0; i < 2; ++i)
            corner.uv[i] = readFinite(reader, "a corner's uv");
        for (int i = 0; i < 3; ++i)
            corner.tangent[i] = readFinite(reader, "a corner's tangent");
        if (corner.uv.x < 0.0f || corner.uv.y < 0.0f || corner.uv.x > side || corner.uv.y > side)
            reader.fail("a corner lies outside the atlas");
    }
}

std::vector<std::uint8_t> encodeTexels(const Atlas& atlas)
{
    ByteWriter writer;
    for (const AtlasTexel& texel : atlas.texels) {
        writer.value(static_cast<std::uint16_t>(texel.x));
        writer.value(static_cast<std::uint16_t>(texel.y));
        writer.value(texel.triangle);
        writer.value(texel.barycentric.x);
        writer.value(texel.barycentric.y);
        writer.value(texel.chart);
    }
    return writer.take();
}

void decodeTexels(ByteReader reader, std::uint64_t count, Atlas& atlas)
{
    expectBytes(reader, count, kTexelBytes);
    constexpr float kSlack = 1e-3f; // of rounding in the weights
    std::int64_t last = -1;
    atlas.texels.resize(count);
    for (AtlasTexel& texel : atlas.texels) {
        texel.x = reader.value<std::uint16_t>();
        texel.y = reader.value<std::uint16_t>();
        texel.triangle = reader.value<std::uint32_t>();
        texel.barycentric.x = readFinite(reader, "a texel's weight");
        texel.barycentric.y = readFinite(reader, "a texel's weight");
        texel.chart = reader.value<std::uint32_t>();
        const std::int64_t index = std::int64_t(texel.y) * atlas.resolution + texel.x;
        const glm::vec2 w = texel.barycentric;
        if (texel.x >= atlas.resolution || texel.y >= atlas.resolution || index <= last ||
            texel.triangle >= atlas.corners.size() / 3 || texel.chart >= atlas.chartCount ||
            w.x < -kSlack || w.y < -kSlack || w.x + w.y > 1.0f + kSlack)
            reader.fail("texel " + std::to_string(&texel - atlas.texels.data()) +
                        " is out of order or out of range");
        last = index;
    }
}

std::vector<std::uint8_t> encodeField(const SgField& field, const Atlas& atlas,
                                      std::uint32_t version, SglStorage storage,
                                      std::uint64_t& clamped)
{
    const SglLobeCoding coding = chooseCoding(field, storage);
    const std::size_t size = sglBytesPerLobe(storage);
    ByteWriter writer;
    writer.value(field.lobeCount);
    writer.value(coding.amplitudeScale);
    writer.value(coding.logSharpnessLow);
    writer.value(coding.logSharpnessHigh);
    if (version > 1)
        encodeMasks(field, atlas, writer);
    const std::span<std::uint8_t> out = writer.extend(field.keptCount() * size);
    std::size_t next = 0;
    for (std::size_t i = 0; i < field.lobes.size(); ++i)
        if ((field.keptBy(i / field.lobeCount) >> (i % field.lobeCount) & 1u) != 0u)
            clamped += encodeLobe(field.lobes[i], coding, out.subspan(next++ * size, size));
    return writer.take();
}

SgField decodeField(ByteReader reader, const Atlas& atlas, std::uint32_t version,
                    SglStorage storage)
{
    SgField field;
    field.lobeCount = reader.value<std::uint32_t>();
    if (field.lobeCount == 0 || field.lobeCount > kMaximumLobes)
        reader.fail("claims " + std::to_string(field.lobeCount) + " lobes per texel");
    SglLobeCoding coding{.storage = storage};
    coding.amplitudeScale = readFinite(reader, "the amplitude scale");
    coding.logSharpnessLow = readFinite(reader, "the sharpness range");
    coding.logSharpnessHigh = readFinite(reader, "the sharpness range");
    if (!(coding.amplitudeScale > 0.0f))
        reader.fail("the amplitude scale is not positive");
    if (version > 1)
        decodeMasks(reader, atlas, field);
    field.lobes.resize(atlas.texels.size() * field.lobeCount); // those not kept are black
    const std::size_t size = sglBytesPerLobe(storage);
    expectBytes(reader, field.keptCount(), size);

    for (std::size_t i = 0; i < field.lobes.size(); ++i) {
        if ((field.keptBy(i / field.lobeCount) >> (i % field.lobeCount) & 1u) == 0u)
            continue;
        const SgLobe lobe = decodeLobe(reader.take(size), coding);
        const glm::vec3& a = lobe.amplitude;
        const bool valid = std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z) &&
                           std::abs(lobe.logSharpness) <= kSglMaximumLogSharpness &&
                           std::abs(glm::length(lobe.axis) - 1.0f) < 0.1f;
        if (!valid)
            reader.fail("lobe " + std::to_string(i % field.lobeCount) + " of texel " +
                        std::to_string(i / field.lobeCount) + " is not a light");
        field.lobes[i] = lobe;
    }
    return field;
}

} // namespace strandlight
