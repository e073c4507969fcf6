// An .sgl file gives back what was stored; what makes no sense is not written.
#include <filesystem>
#include <limits>
#include <unistd.h>

#include <doctest/doctest.h>

#include "tests/unit/sgl_bakes.hpp"

using namespace strandlight;
using namespace strandlight::test;

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
