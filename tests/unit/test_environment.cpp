// Environments: the mapping of directions, and files that are broken.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/image_io.hpp"
#include "engine/base/log.hpp"
#include "engine/scene/environment.hpp"
#include "shaders/shared/rng.h"
#include "tests/support/gltf_maker.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

// A flat Radiance file: texel (x, y) holds the mantissas (x, y, 128) with exponent 129, so 128
// stands for 1.0.
std::vector<std::uint8_t> flatHdr(std::uint32_t width, std::uint32_t height)
{
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
                               std::to_string(height) + " +X " + std::to_string(width) + "\n";
    std::vector<std::uint8_t> bytes(header.begin(), header.end());
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x)
            bytes.insert(bytes.end(),
                         {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 128, 129});
    }
    return bytes;
}

void checkRefused(const std::filesystem::path& path)
{
    CAPTURE(path.filename().string());
    CHECK_THROWS_AS(loadEnvironment(path), FileError);
}

} // namespace

TEST_CASE("directions and texture coordinates are inverse, with -z in the middle")
{
    const auto near = [](glm::vec2 a, glm::vec2 b) { return glm::length(a - b) < 1e-6f; };
    CHECK(near(gpu::environmentUv({0, 0, -1}), {0.5f, 0.5f}));
    CHECK(near(gpu::environmentUv({1, 0, 0}), {0.75f, 0.5f}));
    CHECK(near(gpu::environmentUv({-1, 0, 0}), {0.25f, 0.5f}));
    CHECK(near(gpu::environmentUv({0, 1, 0}), {0.5f, 0.0f}));
    CHECK(near(gpu::environmentUv({0, -1, 0}), {0.5f, 1.0f}));
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const glm::vec3 r = gpu::uniform3(i, 0, 0, 5);
        const glm::vec3 d = gpu::environmentDirection(r.x, r.y);
        CHECK(glm::length(d) == doctest::Approx(1.0));
        const glm::vec2 uv = gpu::environmentUv(3.0f * d);
        // u loses digits near the poles, where a step of u is a short way: compare the way.
        CHECK(std::abs(uv.x - r.x) * std::sin(3.14159265f * r.y) < 2e-6f);
        CHECK(std::abs(uv.y - r.y) < 2e-6f);
    }
}

TEST_CASE("a radiance file keeps its rows and values, lookups wrap around")
{
    const test::TemporaryFolder folder;
    const Environment e = loadEnvironment(folder.write("sky.hdr", flatHdr(4, 2)));
    REQUIRE(e.latLong.width == 4);
    REQUIRE(e.latLong.height == 2);
    CHECK(e.latLong.at(3, 1) == glm::vec4(3 / 128.0f, 1 / 128.0f, 1.0f, 1.0f));
    // The centre of texel (2, 0), and half way between the last and the first column.
    const glm::vec3 centre = environmentRadiance(e, gpu::environmentDirection(2.5f / 4, 0.25f));
    CHECK(glm::length(centre - glm::vec3(2 / 128.0f, 0.0f, 1.0f)) < 1e-5f);
    const glm::vec3 seam = environmentRadiance(e, gpu::environmentDirection(0.0f, 0.25f));
    CHECK(seam.x == doctest::Approx(1.5 / 128.0).epsilon(1e-3));
}

TEST_CASE("environments that cannot be used are refused")
{
    const test::TemporaryFolder folder;
    checkRefused(folder.path() / "absent.hdr");
    checkRefused(folder.write("sky.png", test::plainPng(4, 2)));
    checkRefused(folder.write("text.hdr", {'h', 'e', 'l', 'l', 'o', '\n'}));
    checkRefused(folder.write("empty.hdr", {}));
    const std::vector<std::uint8_t> good = flatHdr(16, 8);
    checkRefused(folder.write("cut.hdr", {good.begin(), good.end() - 5}));
    const std::string huge = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n";
    checkRefused(folder.write("huge.hdr", {huge.begin(), huge.end()}));
    const std::string claim = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4000 +X 8000\n";
    checkRefused(folder.write("claim.hdr", {claim.begin(), claim.end()}));
    std::vector<std::uint8_t> black = good;
    for (std::size_t i = good.size() - 16 * 8 * 4; i < good.size(); ++i)
        black[i] = 0;
    checkRefused(folder.write("black.hdr", black));

    CpuImage image(4, 2, glm::vec4(1.0f));
    image.at(2, 1).y = std::numeric_limits<float>::infinity();
    saveExr(folder.path() / "infinite.exr", image);
    checkRefused(folder.path() / "infinite.exr");
    image.at(2, 1).y = std::numeric_limits<float>::quiet_NaN();
    saveExr(folder.path() / "nan.exr", image);
    checkRefused(folder.path() / "nan.exr");
}

TEST_CASE("negative values become black, with a warning")
{
    const test::TemporaryFolder folder;
    CpuImage image(4, 2, glm::vec4(1.0f));
    image.at(1, 0).x = -0.25f;
    saveExr(folder.path() / "ringing.exr", image);
    int warnings = 0;
    const LogSink previous = setLogSink([&](LogLevel level, const std::string&) {
        warnings += level == LogLevel::Warning ? 1 : 0;
    });
    const Environment e = loadEnvironment(folder.path() / "ringing.exr");
    setLogSink(previous);
    CHECK(e.latLong.at(1, 0).x == 0.0f);
    CHECK(e.latLong.at(1, 0).y == 1.0f);
    CHECK(warnings == 1);
}

TEST_CASE("mutated radiance files are loaded or refused, never worse")
{
    const test::TemporaryFolder folder;
    const std::vector<std::uint8_t> seed = flatHdr(24, 6);
    int refused = 0;
    for (std::uint32_t round = 0; round < 400; ++round) {
        std::vector<std::uint8_t> bytes = seed;
        for (std::uint32_t edit = 0; edit <= round % 3; ++edit) {
            const glm::uvec3 h = gpu::hashPcg3(glm::uvec3(round, edit, 3));
            // Half of the edits hit the header, where the claims are.
            const std::size_t at = h.x % (h.y % 2 == 0 ? 56 : bytes.size());
            if (h.y % 7 == 0)
                bytes.resize(at + 1);
            else if (at < bytes.size())
                bytes[at] = static_cast<std::uint8_t>(h.y % 3 == 0 ? '0' + h.z % 10 : h.z);
        }
        try {
            const Environment e = loadEnvironment(folder.write("mutant.hdr", bytes));
            CHECK(e.latLong.pixels.size() == std::size_t(e.latLong.width) * e.latLong.height);
        } catch (const Error&) {
            ++refused;
        }
    }
    MESSAGE(refused << " of 400 mutated files refused");
    CHECK(refused > 50);
    CHECK(refused < 400);
}

TEST_CASE("real environments load")
{
    const std::string folder = test::dataFolder();
    if (folder.empty()) {
        MESSAGE("no test data: skipped");
        return;
    }
    const LogSink previous =
        setLogSink([](LogLevel, const std::string&) {}); // they may hold negative values
    for (const char* name : {"std_env.hdr", "spruit_sunrise_1k.hdr", "polyhaven_lobby.exr"}) {
        const std::filesystem::path file = std::filesystem::path(folder) / "env" / name;
        if (!std::filesystem::exists(file)) {
            MESSAGE(name << " is absent: skipped");
            continue;
        }
        CAPTURE(name);
        const Environment e = loadEnvironment(file);
        CHECK(e.latLong.width == 2 * e.latLong.height);
    }
    setLogSink(previous);
}
