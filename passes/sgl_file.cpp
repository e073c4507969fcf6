#include "passes/sgl_file.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "passes/sgl_chunks.hpp"

namespace strandlight {

namespace {

// The PNG trick: a high bit, line ends and a control character, so text transfers that damage the
// file are seen.
constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'S', 'G', 'L', '\r', '\n', 0x1a, '\n'};
constexpr std::uint64_t kHeaderBytes = 32;
constexpr std::uint64_t kEntryBytes = 24;
constexpr std::uint64_t kCrcOffset = 28;
constexpr std::array<std::string_view, 6> kTags = {"INFO", "ATLS", "CRNR", "TEXL", "RADL", "ENVL"};
constexpr std::size_t kFewestChunks = 5;

enum ChunkIndex : std::size_t
{
    kInfo,
    kAtlas,
    kCorners,
    kTexels,
    kRadiance,
    kEnvironment
};

void checkField(const SgField& field, const Atlas& atlas, const char* name)
{
    if (field.lobeCount == 0 || field.lobeCount > kMaximumLobes ||
        field.lobes.size() != atlas.texels.size() * field.lobeCount ||
        field.kept.size() != (field.tileSize > 0 ? atlas.texels.size() : 0))
        throw Error(std::string("cannot store a bake whose ") + name + " field has " +
                    std::to_string(field.lobes.size()) + " lobes for " +
                    std::to_string(atlas.texels.size()) + " texels of " +
                    std::to_string(field.lobeCount));
}

// The CRC covers header and table, its own four bytes taken as zero.
std::uint32_t headerCrc(std::span<const std::uint8_t> headerAndTable)
{
    constexpr std::array<std::uint8_t, 4> kZero{};
    const std::uint32_t before = crc32(headerAndTable.first(kCrcOffset));
    return crc32(headerAndTable.subspan(kHeaderBytes), crc32(kZero, before));
}

std::vector<std::uint8_t> assembleFile(const std::vector<std::vector<std::uint8_t>>& chunks,
                                       std::uint32_t version, SglStorage storage)
{
    std::uint64_t offset = kHeaderBytes + kEntryBytes * chunks.size();
    std::uint64_t total = offset;
    for (const auto& chunk : chunks)
        total += chunk.size();
    ByteWriter writer;
    for (const std::uint8_t byte : kMagic)
        writer.value(byte);
    writer.value(version);
    writer.value(storage);
    writer.value(total);
    writer.value(static_cast<std::uint32_t>(chunks.size()));
    writer.value(std::uint32_t(0));
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        for (const char c : kTags[i])
            writer.value(c);
        writer.value(crc32(chunks[i]));
        writer.value(offset);
        writer.value(static_cast<std::uint64_t>(chunks[i].size()));
        offset += chunks[i].size();
    }
    std::vector<std::uint8_t> bytes = writer.take();
    const std::uint32_t crc = headerCrc(bytes);
    std::memcpy(&bytes[kCrcOffset], &crc, sizeof(crc));
    for (const auto& chunk : chunks)
        bytes.insert(bytes.end(), chunk.begin(), chunk.end());
    return bytes;
}

struct Header
{
    std::uint32_t version = 0;
    SglStorage storage = SglStorage::Fp16;
    std::size_t chunkCount = 0;
};

// Everything that decides how to read on.
Header readHeader(ByteReader& reader, std::span<const std::uint8_t> bytes)
{
    for (const std::uint8_t byte : kMagic)
        if (reader.value<std::uint8_t>() != byte)
            reader.fail("is not an .sgl file (wrong magic number)");
    const auto version = reader.value<std::uint32_t>();
    if (version < 1 || version > kSglVersion)
        reader.fail("has version " + std::to_string(version) +
                    ", this program reads versions 1 to " + std::to_string(kSglVersion) +
                    ": bake again");
    const auto storageCode = reader.value<std::uint32_t>();
    const auto total = reader.value<std::uint64_t>();
    if (total != bytes.size())
        reader.fail("should have " + std::to_string(total) + " bytes and has " +
                    std::to_string(bytes.size()));
    const auto count = reader.value<std::uint32_t>();
    const auto crc = reader.value<std::uint32_t>();
    if (count < kFewestChunks || count > kTags.size())
        reader.fail("claims " + std::to_string(count) + " chunks");
    reader.take(kEntryBytes * count);
    if (crc != headerCrc(bytes.first(kHeaderBytes + kEntryBytes * count)))
        reader.fail("is damaged (wrong checksum)");
    if (storageCode > 1)
        reader.fail("has the unknown storage " + std::to_string(storageCode));
    return {version, static_cast<SglStorage>(storageCode), count};
}

// The chunks' bytes in order of kTags, each with the right checksum, together the whole file.
std::vector<ByteReader> readChunks(std::span<const std::uint8_t> bytes, const std::string& name,
                                   Header& header)
{
    ByteReader reader(bytes, name, "header");
    header = readHeader(reader, bytes);
    const std::size_t count = header.chunkCount;
    ByteReader table(bytes.subspan(kHeaderBytes, kEntryBytes * count), name, "chunk table");
    std::uint64_t expected = kHeaderBytes + kEntryBytes * count;
    std::vector<ByteReader> chunks;
    for (std::size_t i = 0; i < count; ++i) {
        const auto tag = table.take(4);
        const auto crc = table.value<std::uint32_t>();
        const auto offset = table.value<std::uint64_t>();
        const auto size = table.value<std::uint64_t>();
        const std::string place = "chunk " + std::string(kTags[i]);
        if (!std::equal(tag.begin(), tag.end(), kTags[i].begin()) || offset != expected ||
            size > bytes.size() - offset)
            throw FileError(name, place, "is missing or misplaced");
        const auto chunk = bytes.subspan(offset, size);
        if (crc32(chunk) != crc)
            throw FileError(name, place, "is damaged (wrong checksum)");
        chunks.emplace_back(chunk, name, place);
        expected = offset + size;
    }
    if (expected != bytes.size())
        table.fail("the chunks end at byte " + std::to_string(expected) + ", the file at " +
                   std::to_string(bytes.size()));
    return chunks;
}

} // namespace

std::vector<std::uint8_t> encodeSgl(const SgBake& bake, SglStorage storage, SglSaveReport* report)
{
    checkField(bake.radiance, bake.atlas, "radiance");
    if (bake.environment)
        checkField(*bake.environment, bake.atlas, "environment");
    const bool tiled =
        bake.radiance.tileSize > 0 || (bake.environment && bake.environment->tileSize > 0);
    const std::uint32_t version = tiled ? kSglVersion : 1;
    std::uint64_t clamped = 0;
    std::vector<std::vector<std::uint8_t>> chunks = {
        encodeInfo(bake.info), encodeAtlasSizes(bake.atlas), encodeCorners(bake.atlas),
        encodeTexels(bake.atlas),
        encodeField(bake.radiance, bake.atlas, version, storage, clamped)};
    if (bake.environment)
        chunks.push_back(encodeField(*bake.environment, bake.atlas, version, storage, clamped));
    std::vector<std::uint8_t> bytes = assembleFile(chunks, version, storage);
    if (report != nullptr) {
        std::uint64_t all = 16 + bake.radiance.lobes.size() * sglBytesPerLobe(storage);
        std::uint64_t stored = chunks[kRadiance].size();
        if (bake.environment) {
            all += 16 + bake.environment->lobes.size() * sglBytesPerLobe(storage);
            stored += chunks[kEnvironment].size();
        }
        const double texels = double(std::max<std::size_t>(bake.atlas.texels.size(), 1));
        const std::uint64_t heads = bake.environment ? 32 : 16;
        *report = {bytes.size(), double(stored - heads) / texels, all - std::min(stored, all),
                   clamped};
    }
    return bytes;
}

SgBake decodeSgl(std::span<const std::uint8_t> bytes, const std::string& name)
{
    Header header;
    const std::vector<ByteReader> chunks = readChunks(bytes, name, header);
    std::uint64_t cornerCount = 0;
    std::uint64_t texelCount = 0;
    SgBake bake;
    bake.info = decodeInfo(chunks[kInfo]);
    bake.atlas = decodeAtlasSizes(chunks[kAtlas], cornerCount, texelCount);
    decodeCorners(chunks[kCorners], cornerCount, bake.atlas);
    decodeTexels(chunks[kTexels], texelCount, bake.atlas);
    bake.radiance = decodeField(chunks[kRadiance], bake.atlas, header.version, header.storage);
    if (chunks.size() > kEnvironment)
        bake.environment =
            decodeField(chunks[kEnvironment], bake.atlas, header.version, header.storage);
    return bake;
}

SglSaveReport saveSgl(const std::filesystem::path& path, const SgBake& bake, SglStorage storage)
{
    SglSaveReport report;
    const std::vector<std::uint8_t> bytes = encodeSgl(bake, storage, &report);
    // A bake takes minutes: one that could not be loaded again must not replace a good file.
    decodeSgl(bytes, path.string());
    writeFileAtomically(path, bytes);
    return report;
}

SgBake loadSgl(const std::filesystem::path& path)
{
    return decodeSgl(readFile(path), path.string());
}

} // namespace strandlight
