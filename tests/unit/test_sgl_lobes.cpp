// Lobes come back from an .sgl file within the bounds of their coding, those that were kept.
#include <algorithm>

#include <doctest/doctest.h>

#include "tests/unit/sgl_bakes.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

float angleBetween(glm::vec3 a, glm::vec3 b)
{
    return 2.0f * std::asin(std::min(1.0f, 0.5f * glm::distance(a, b)));
}

} // namespace

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
