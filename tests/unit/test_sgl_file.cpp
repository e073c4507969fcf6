// An .sgl file gives back what was stored, within the bounds of its coding; any other bytes are
// refused.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <unistd.h>
#include <utility>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/scene/scene_loader.hpp"
#include "passes/sgl_file.hpp"
#include "shaders/shared/rng.h"

using namespace strandlight;

namespace {

// Amplitudes over eight decades, sharpness from 0.1 to 10^4, axes over the upper hemisphere.
SgField makeField(std::size_t texels, std::uint32_t lobeCount, std::uint32_t seed)
{
    SgField field;
    field.lobeCount = lobeCount;
    for (std::uint32_t i = 0; i < texels * lobeCount; ++i) {
        const glm::vec3 a = gpu::uniform3(i, 0, 0, seed);
        const glm::vec3 b = gpu::uniform3(i, 1, 0, seed);
        const float z = a.x;
        const float r = std::sqrt(1.0f - z * z);
        SgLobe lobe;
        lobe.axis = {r * std::cos(6.2831853f * a.y), r * std::sin(6.2831853f * a.y), z};
        lobe.logSharpness = std::log(0.1f) + a.z * std::log(1e5f);
        lobe.amplitude = glm::vec3(b.x, b.y, 0.3f) * std::pow(10.0f, 8.0f * b.z - 4.0f);
        field.lobes.push_back(lobe);
    }
    return field;
}

SgBake makeBake(std::uint32_t resolution, bool withEnvironment)
{
    SgBake bake;
    bake.info = {.scene = "builtin:room",
                 .fitMode = "direct",
                 .geometryHash = 0x123456789ABCDEFull,
                 .environmentHash = 42,
                 .lightfieldSize = 16,
                 .samplesPerDirection = 4,
                 .bounces = 6,
                 .steps = 600,
                 .seed = 7,
                 .rmse = 0.25f};
    bake.atlas = buildAtlas(loadScene("builtin:furnace"), {.resolution = resolution, .gutter = 2});
    bake.radiance = makeField(bake.atlas.texels.size(), 3, 1);
    if (withEnvironment)
        bake.environment = makeField(bake.atlas.texels.size(), 2, 2);
    return bake;
}

// Tiles of 4 x 4 texels that keep lobes by chance, some none, some all.
SgBake makeTiledBake(std::uint32_t resolution)
{
    SgBake bake = makeBake(resolution, true);
    bake.radiance = makeField(bake.atlas.texels.size(), 11, 3); // two bytes a mask
    bake.radiance.tileSize = 4;
    const LobeTiles tiles = lobeTiles(bake.atlas, 4);
    for (const std::uint32_t tile : tiles.tileOf) {
        const std::uint32_t mask = gpu::hashPcg(tile) & bake.radiance.allLobes();
        bake.radiance.kept.push_back(tile % 5 == 0 ? 0u : tile % 5 == 1 ? 0x7ffu : mask);
    }
    return bake;
}

std::string errorOf(std::span<const std::uint8_t> bytes)
{
    try {
        decodeSgl(bytes, "test.sgl");
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

// Makes the checksums right again after a change, as a hostile writer would.
void repairChecksums(std::vector<std::uint8_t>& bytes)
{
    const auto put = [&](std::size_t at, std::uint32_t value) {
        std::memcpy(&bytes[at], &value, 4);
    };
    const std::size_t chunkCount = bytes[24];
    std::size_t offset = 32 + 24 * chunkCount;
    for (std::size_t i = 0; i < chunkCount; ++i) {
        std::uint64_t size = 0;
        std::memcpy(&size, &bytes[32 + 24 * i + 16], 8);
        put(32 + 24 * i + 4, crc32(std::span(std::as_const(bytes)).subspan(offset, size)));
        offset += size;
    }
    put(28, 0);
    put(28, crc32(std::span(std::as_const(bytes)).first(32 + 24 * chunkCount)));
}

float angleBetween(glm::vec3 a, glm::vec3 b)
{
    return 2.0f * std::asin(std::min(1.0f, 0.5f * glm::distance(a, b)));
}

} // namespace

TEST_CASE("sgl: everything but the lobes comes back exactly")
{
    for (const bool withEnvironment : {false, true}) {
        const SgBake a = makeBake(24, withEnvironment);
        const SgBake b = decodeSgl(encodeSgl(a, SglStorage::Fp16), "memory");
        CHECK(b.info.scene == a.info.scene);
        CHECK(b.info.fitMode == a.info.fitMode);
        CHECK(b.info.geometryHash == a.info.geometryHash);
        CHECK(b.info.environmentHash == a.info.environmentHash);
        CHECK(b.info.lightfieldSize == 16);
        CHECK(b.info.samplesPerDirection == 4);
        CHECK(b.info.bounces == 6);
        CHECK(b.info.steps == 600);
        CHECK(b.info.seed == 7);
        CHECK(b.info.rmse == 0.25f);
        CHECK(b.atlas.resolution == 24);
        CHECK(b.atlas.chartCount == a.atlas.chartCount);
        CHECK(b.atlas.usedTexCoord1 == a.atlas.usedTexCoord1);
        CHECK(b.atlas.texelsPerMetre == a.atlas.texelsPerMetre);
        REQUIRE(b.atlas.corners.size() == a.atlas.corners.size());
        for (std::size_t i = 0; i < a.atlas.corners.size(); ++i) {
            CHECK(b.atlas.corners[i].uv == a.atlas.corners[i].uv);
            CHECK(b.atlas.corners[i].tangent == a.atlas.corners[i].tangent);
        }
        REQUIRE(b.atlas.texels.size() == a.atlas.texels.size());
        for (std::size_t i = 0; i < a.atlas.texels.size(); ++i) {
            CHECK(b.atlas.texels[i].x == a.atlas.texels[i].x);
            CHECK(b.atlas.texels[i].y == a.atlas.texels[i].y);
            CHECK(b.atlas.texels[i].triangle == a.atlas.texels[i].triangle);
            CHECK(b.atlas.texels[i].barycentric == a.atlas.texels[i].barycentric);
            CHECK(b.atlas.texels[i].chart == a.atlas.texels[i].chart);
        }
        CHECK(b.radiance.lobeCount == 3);
        CHECK(b.radiance.lobes.size() == a.radiance.lobes.size());
        CHECK(b.environment.has_value() == withEnvironment);
    }
}

TEST_CASE("sgl: fp16 lobes come back within fp16 rounding")
{
    const SgBake a = makeBake(32, true);
    const SgBake b = decodeSgl(encodeSgl(a, SglStorage::Fp16), "memory");
    for (std::size_t i = 0; i < a.radiance.lobes.size(); ++i) {
        const SgLobe& x = a.radiance.lobes[i];
        const SgLobe& y = b.radiance.lobes[i];
        // 65,534 steps over an octahedron of side 2: half a diagonal step, stretched by at most
        // sqrt(3).
        CHECK(angleBetween(x.axis, y.axis) < 6.4e-5f);
        // fp16 has 11 bits: half a step is 2^-12 of a power of two, here up to 16.
        CHECK(std::abs(x.logSharpness - y.logSharpness) <= 16.0f / 4096.0f);
        for (int c = 0; c < 3; ++c)
            CHECK(std::abs(x.amplitude[c] - y.amplitude[c]) <= x.amplitude[c] / 2048.0f + 1e-5f);
    }
}

TEST_CASE("sgl: packed lobes come back within their coarser steps, at two thirds of the size")
{
    const SgBake a = makeBake(32, true);
    SglSaveReport full;
    SglSaveReport packed;
    encodeSgl(a, SglStorage::Fp16, &full);
    const SgBake b = decodeSgl(encodeSgl(a, SglStorage::Packed, &packed), "memory");
    CHECK(full.lobeBytesPerTexel == 60);
    CHECK(packed.lobeBytesPerTexel == 40);
    CHECK(packed.clampedLobes == 0);
    CHECK(packed.fileBytes < full.fileBytes);
    const float range = std::log(1e5f);
    for (std::size_t i = 0; i < a.radiance.lobes.size(); ++i) {
        const SgLobe& x = a.radiance.lobes[i];
        const SgLobe& y = b.radiance.lobes[i];
        CHECK(angleBetween(x.axis, y.axis) < 1.02e-3f); // 4,094 steps, as above
        CHECK(std::abs(x.logSharpness - y.logSharpness) <= range / 510.0f + 1e-5f);
        // Nine bits relative to the brightest channel.
        const float brightest = std::max({x.amplitude.x, x.amplitude.y, x.amplitude.z});
        for (int c = 0; c < 3; ++c)
            CHECK(std::abs(x.amplitude[c] - y.amplitude[c]) <= brightest / 511.0f + 1e-5f);
    }
}

TEST_CASE("sgl: the axis N, very bright and very dark fields survive")
{
    for (const float level : {1e-20f, 1e-3f, 1.0f, 1e6f, 1e30f}) {
        for (const SglStorage storage : {SglStorage::Fp16, SglStorage::Packed}) {
            CAPTURE(level);
            SgBake bake = makeBake(16, false);
            for (SgLobe& lobe : bake.radiance.lobes)
                lobe = {.axis = {0.0f, 0.0f, 1.0f},
                        .logSharpness = 2.0f,
                        .amplitude = glm::vec3(level, level * 0.5f, 0.0f)};
            const SgBake again = decodeSgl(encodeSgl(bake, storage), "memory");
            for (const SgLobe& lobe : again.radiance.lobes) {
                CHECK(lobe.axis == glm::vec3(0.0f, 0.0f, 1.0f));
                CHECK(lobe.amplitude.x == doctest::Approx(level).epsilon(0.002));
                CHECK(lobe.amplitude.y == doctest::Approx(level * 0.5f).epsilon(0.002));
                CHECK(lobe.amplitude.z == 0.0f);
            }
        }
    }
}

TEST_CASE("sgl: negative amplitudes are kept in fp16, clamped and counted when packed")
{
    SgBake bake = makeBake(16, false);
    bake.radiance.lobes[5].amplitude.y = -1.0f;
    SglSaveReport report;
    CHECK(
        decodeSgl(encodeSgl(bake, SglStorage::Fp16, &report), "m").radiance.lobes[5].amplitude.y ==
        doctest::Approx(-1.0).epsilon(0.01));
    CHECK(report.clampedLobes == 0);
    CHECK(decodeSgl(encodeSgl(bake, SglStorage::Packed, &report), "m")
              .radiance.lobes[5]
              .amplitude.y == 0.0f);
    CHECK(report.clampedLobes == 1);
}

TEST_CASE("sgl: bakes that make no sense are not written")
{
    const auto refused = [](auto change) {
        SgBake bake = makeBake(16, false);
        change(bake);
        CHECK_THROWS_AS(encodeSgl(bake, SglStorage::Fp16), Error);
    };
    refused([](SgBake& b) { b.radiance.lobes[3].amplitude.x = std::nanf(""); });
    refused([](SgBake& b) {
        b.radiance.lobes[3].logSharpness = std::numeric_limits<float>::infinity();
    });
    refused([](SgBake& b) { b.radiance.lobes[3].logSharpness = 17.0f; });
    refused([](SgBake& b) { b.radiance.lobes[3].axis *= 0.8f; });
    refused([](SgBake& b) { b.radiance.lobes[3].axis = glm::vec3(0.0f); });
    refused([](SgBake& b) { b.radiance.lobes.pop_back(); });
    refused([](SgBake& b) { b.radiance.lobeCount = 0; });
}

TEST_CASE("sgl: the same bake gives the same bytes")
{
    const SgBake bake = makeBake(24, true);
    CHECK(encodeSgl(bake, SglStorage::Fp16) == encodeSgl(bake, SglStorage::Fp16));
    CHECK(encodeSgl(bake, SglStorage::Packed) == encodeSgl(bake, SglStorage::Packed));
}

TEST_CASE("sgl: texels get back the lobes that they keep, and black ones in place of the others")
{
    const SgBake a = makeTiledBake(24);
    SglSaveReport report;
    const auto bytes = encodeSgl(a, SglStorage::Fp16, &report);
    const SgBake b = decodeSgl(bytes, "memory");
    CHECK(bytes[8] == 2);
    CHECK(b.radiance.tileSize == 4);
    CHECK(b.radiance.kept == a.radiance.kept);
    CHECK(b.radiance.keptCount() < a.radiance.lobes.size());
    CHECK(b.environment->kept.empty()); // one field with tiles, one without
    for (std::size_t i = 0; i < a.radiance.lobes.size(); ++i) {
        const bool kept = (a.radiance.kept[i / 11] >> (i % 11) & 1u) != 0u;
        const glm::vec3 expected = kept ? a.radiance.lobes[i].amplitude : glm::vec3(0.0f);
        CHECK(glm::distance(b.radiance.lobes[i].amplitude, expected) <=
              glm::length(expected) / 1024.0f + 1e-4f);
    }
    // 12 bytes a dropped lobe, less the tile size and two bytes a tile.
    const std::uint64_t dropped = a.radiance.lobes.size() - a.radiance.keptCount();
    CHECK(report.savedBytes == dropped * 12 - 4 - 4 - 2 * lobeTiles(a.atlas, 4).count);
}

TEST_CASE("sgl: a field of no light at all takes a mask per tile")
{
    SgBake bake = makeBake(24, false);
    bake.radiance.tileSize = 8;
    bake.radiance.kept.assign(bake.atlas.texels.size(), 0u);
    SglSaveReport report;
    const SgBake again = decodeSgl(encodeSgl(bake, SglStorage::Packed, &report), "memory");
    CHECK(again.radiance.keptCount() == 0);
    CHECK(report.lobeBytesPerTexel < 1.0);
}

TEST_CASE("sgl: masks that make no sense are refused")
{
    SgBake bake = makeTiledBake(16);
    bake.radiance.kept[1] ^= 1u; // another than its tile's
    CHECK_THROWS_AS(encodeSgl(bake, SglStorage::Fp16), Error);
    bake = makeTiledBake(16);
    bake.radiance.kept.pop_back();
    CHECK_THROWS_AS(encodeSgl(bake, SglStorage::Fp16), Error);

    const auto good = encodeSgl(makeTiledBake(16), SglStorage::Fp16);
    std::uint64_t radiance = 0; // offset of its chunk
    std::memcpy(&radiance, &good[32 + 24 * 4 + 8], 8);
    const auto changed = [&](std::size_t at, std::uint8_t value) {
        auto bytes = good;
        bytes[radiance + at] = value;
        repairChecksums(bytes);
        return errorOf(bytes);
    };
    CHECK(changed(0, 33).find("claims 33 lobes") != std::string::npos);
    CHECK(changed(18, 1).find("claims tiles of 65540 texels") != std::string::npos);
    CHECK(changed(21, 0xff).find("lobes that are not there") != std::string::npos); // bits 8..15
    CHECK(changed(16, 3).find("chunk RADL") != std::string::npos); // another number of tiles
}

TEST_CASE("sgl: a file cut anywhere is refused")
{
    const auto bytes = encodeSgl(makeTiledBake(24), SglStorage::Fp16);
    for (std::size_t size = 0; size < bytes.size(); size += 64)
        CHECK(!errorOf(std::span(bytes).first(size)).empty());
    CHECK(!errorOf(std::span(bytes).first(bytes.size() - 1)).empty());
    auto longer = bytes;
    longer.push_back(0);
    CHECK(!errorOf(longer).empty());
}

TEST_CASE("sgl: every flipped bit is found")
{
    auto bytes = encodeSgl(makeTiledBake(8), SglStorage::Packed);
    std::size_t missed = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        for (int bit = 0; bit < 8; ++bit) {
            bytes[i] ^= static_cast<std::uint8_t>(1u << bit);
            missed += errorOf(bytes).empty();
            bytes[i] ^= static_cast<std::uint8_t>(1u << bit);
        }
    }
    CHECK(missed == 0);
    CHECK(errorOf(bytes).empty());
}

TEST_CASE("sgl: altered contents under right checksums give a bake in range or one error")
{
    const std::vector<std::uint8_t> versions[2] = {encodeSgl(makeBake(10, true), SglStorage::Fp16),
                                                   encodeSgl(makeTiledBake(10), SglStorage::Fp16)};
    auto same = versions[0];
    repairChecksums(same);
    REQUIRE(same == versions[0]);
    const std::size_t contents = 32 + 24 * 6;
    std::size_t refused = 0;
    for (std::uint32_t round = 0; round < 6000; ++round) {
        auto bytes = versions[round / 2 % 2];
        const glm::uvec3 draw = gpu::hashPcg3({round, 1, 2});
        // The sizes in the front, and the rest, in equal parts.
        const std::size_t range = round % 2 ? 200 : bytes.size() - contents;
        bytes[contents + draw.x % range] = static_cast<std::uint8_t>(draw.y);
        bytes[contents + draw.z % range] = static_cast<std::uint8_t>(draw.y >> 8);
        repairChecksums(bytes);
        try {
            const SgBake bake = decodeSgl(bytes, "test.sgl");
            for (const AtlasTexel& texel : bake.atlas.texels)
                CHECK(texel.triangle < bake.atlas.corners.size() / 3);
            CHECK(bake.radiance.keptCount() <= bake.radiance.lobes.size());
            for (const SgLobe& lobe : bake.radiance.lobes)
                CHECK(std::isfinite(lobe.amplitude.x + lobe.amplitude.y + lobe.amplitude.z));
        } catch (const FileError&) {
            ++refused;
        }
    }
    CHECK(refused > 500);
}

TEST_CASE("sgl: errors name the file and the reason")
{
    auto bytes = encodeSgl(makeBake(8, false), SglStorage::Fp16);
    CHECK(errorOf({}).find("test.sgl: header") != std::string::npos);
    CHECK(bytes[8] == 1); // without dropped lobes, the file is as it always was
    bytes[8] = 9;
    CHECK(errorOf(bytes).find("version 9, this program reads versions 1 to 2") !=
          std::string::npos);
    bytes[8] = 1;
    bytes[1] = 'X';
    CHECK(errorOf(bytes).find("magic") != std::string::npos);
    bytes[1] = 'S';
    bytes.back() ^= 1u;
    CHECK(errorOf(bytes).find("chunk RADL: is damaged") != std::string::npos);
    CHECK_THROWS_AS(loadSgl("/nonexistent/file.sgl"), FileError);
}

TEST_CASE("sgl: a bake that could not be loaded again does not replace a good file")
{
    const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                       ("strandlight_" + std::to_string(::getpid()) + ".sgl");
    SgBake bake = makeBake(16, false);
    const SglSaveReport report = saveSgl(path, bake);
    CHECK(std::filesystem::file_size(path) == report.fileBytes);
    CHECK(loadSgl(path).radiance.lobes.size() == bake.radiance.lobes.size());
    const auto before = readFile(path);
    bake.atlas.texels[4].triangle = 1000000;
    CHECK_THROWS_AS(saveSgl(path, bake), FileError);
    CHECK(readFile(path) == before);
    std::filesystem::remove(path);
}
