// Damaged and hostile .sgl files: any other bytes are refused.
#include <doctest/doctest.h>

#include "tests/unit/sgl_bakes.hpp"

using namespace strandlight;
using namespace strandlight::test;

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
