// Pictures survive a round trip; broken ones are refused with one clear error and never half read.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <unistd.h>
#include <utility>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/image_io.hpp"
#include "engine/base/log.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
namespace fs = std::filesystem;

namespace {

class TemporaryFolder
{
public:
    TemporaryFolder()
        : path_(fs::temp_directory_path() / ("strandlight_image_io_" + std::to_string(::getpid())))
    {
        fs::create_directories(path_);
    }
    ~TemporaryFolder() { fs::remove_all(path_); }
    fs::path operator/(const std::string& name) const { return path_ / name; }

private:
    fs::path path_;
};

CpuImage makeRamp(std::uint32_t width, std::uint32_t height)
{
    CpuImage image(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            image.at(x, y) = {0.01f * static_cast<float>(x), 1000.0f / static_cast<float>(y + 1),
                              1e-6f * static_cast<float>(x * y), 1.0f};
    return image;
}

std::vector<std::uint8_t> bytesOf(const std::string& text)
{
    return {text.begin(), text.end()};
}

std::string errorOf(const fs::path& path)
{
    try {
        loadImage(path);
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

// Every prefix of a file must be refused, since each byte carries pixels.
void checkTruncations(const fs::path& source, const fs::path& scratch, std::size_t step)
{
    const auto bytes = readFile(source);
    for (std::size_t size = 0; size < bytes.size(); size += step) {
        writeFileAtomically(scratch, std::span(bytes).first(size));
        CHECK_MESSAGE(!errorOf(scratch).empty(), source.string(), " cut to ", size, " bytes loads");
    }
}

// Flipped bits may change pixels, but must end in a picture or a FileError.
void checkMutations(const fs::path& source, const fs::path& scratch)
{
    const auto bytes = readFile(source);
    std::uint32_t state = 12345;
    for (int round = 0; round < 300; ++round) {
        auto broken = bytes;
        for (int k = 0; k < 3; ++k) {
            state = state * 1664525u + 1013904223u;
            // Headers deserve most of the attempts.
            const std::size_t range =
                round % 2 ? broken.size() : std::min<std::size_t>(400, broken.size());
            broken[(state >> 8) % range] ^= static_cast<std::uint8_t>(1u << (state >> 5 & 7u));
        }
        writeFileAtomically(scratch, std::span(std::as_const(broken)));
        CHECK_NOTHROW(errorOf(scratch));
    }
}

} // namespace

TEST_CASE("PNG: every 8-bit value survives decode, linearise, encode")
{
    const TemporaryFolder folder;
    CpuImage image(256, 1);
    for (std::uint32_t i = 0; i < 256; ++i)
        image.at(i, 0) = glm::vec4(glm::vec3(decodeSrgb(static_cast<float>(i) / 255.0f)), 1.0f);
    savePng(folder / "ramp.png", image);
    const Image8 coded = decodeImage8(readFile(folder / "ramp.png"), "ramp");
    REQUIRE(coded.width == 256);
    REQUIRE(coded.height == 1);
    for (std::size_t i = 0; i < 256; ++i)
        CHECK(coded.rgba[i * 4] == i);
    const CpuImage again = loadImage(folder / "ramp.png");
    CHECK(again.pixels == image.pixels);
}

TEST_CASE("sRGB: known values of IEC 61966-2-1")
{
    CHECK(encodeSrgb(0.0f) == 0.0f);
    CHECK(encodeSrgb(1.0f) == doctest::Approx(1.0f));
    CHECK(encodeSrgb(0.21404114f) == doctest::Approx(0.5f).epsilon(1e-5));
    CHECK(decodeSrgb(0.04045f) == doctest::Approx(0.0031308f).epsilon(1e-4));
}

TEST_CASE("PNG: non-finite pixels are magenta and warned about, out of range is clamped")
{
    std::string warning;
    const LogSink previous = setLogSink([&](LogLevel, const std::string& text) { warning = text; });
    CpuImage image(3, 1);
    image.at(0, 0) = {std::nanf(""), 0.0f, 0.0f, 1.0f};
    image.at(1, 0) = {0.0f, std::numeric_limits<float>::infinity(), 0.0f, 1.0f};
    image.at(2, 0) = {-1.0f, 0.0f, 7.0f, 1.0f};
    const Image8 coded = decodeImage8(encodePng(image), "memory");
    setLogSink(previous);
    CHECK(warning.find("2 pixels are not finite") != std::string::npos);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(coded.rgba[i * 4 + 0] == 255);
        CHECK(coded.rgba[i * 4 + 1] == 0);
        CHECK(coded.rgba[i * 4 + 2] == 255);
    }
    CHECK(coded.rgba[8] == 0);
    CHECK(coded.rgba[10] == 255);
}

TEST_CASE("EXR: fp32 survives bit for bit, also odd sizes")
{
    const TemporaryFolder folder;
    for (const auto& [width, height] : {std::pair(1u, 1u), {7u, 33u}, {64u, 16u}, {129u, 17u}}) {
        const CpuImage image = makeRamp(width, height);
        saveExr(folder / "a.exr", image);
        const CpuImage again = loadImage(folder / "a.exr");
        REQUIRE(again.width == width);
        REQUIRE(again.height == height);
        CHECK(again.pixels == image.pixels);
    }
}

TEST_CASE("EXR: broken files are refused")
{
    const TemporaryFolder folder;
    saveExr(folder / "good.exr", makeRamp(20, 40));
    checkTruncations(folder / "good.exr", folder / "cut.exr", 13);
    checkMutations(folder / "good.exr", folder / "broken.exr");
}

TEST_CASE("EXR: a foreign compression is named in the error")
{
    const TemporaryFolder folder;
    saveExr(folder / "good.exr", makeRamp(8, 8));
    auto bytes = readFile(folder / "good.exr");
    const std::string key = std::string("compression\0compression\0", 24);
    const auto at = std::search(bytes.begin(), bytes.end(), key.begin(), key.end());
    REQUIRE(at != bytes.end());
    at[28] = 4;
    writeFileAtomically(folder / "piz.exr", std::span(std::as_const(bytes)));
    const std::string text = errorOf(folder / "piz.exr");
    CHECK(text.find("PIZ") != std::string::npos);
    CHECK(text.find("piz.exr") != std::string::npos);
}

TEST_CASE("HDR: flat, repeated and run-length rows decode to known radiance")
{
    const TemporaryFolder folder;
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    // (128, 64, 0) with exponent 129 is (1, 0.5, 0).
    const std::string pixel("\x80\x40\x00\x81", 4);
    writeFileAtomically(folder / "flat.hdr", header + "-Y 1 +X 2\n" + pixel + pixel);
    writeFileAtomically(folder / "old.hdr",
                        header + "-Y 1 +X 4\n" + pixel + std::string("\x01\x01\x01\x03", 4));
    writeFileAtomically(folder / "run.hdr",
                        header + "-Y 1 +X 9\n" +
                            std::string("\x02\x02\x00\x09\x89\x80\x89\x40\x89\x00\x89\x81", 12));
    for (const char* name : {"flat.hdr", "old.hdr", "run.hdr"}) {
        CAPTURE(name);
        const CpuImage image = loadImage(folder / name);
        for (const glm::vec4& p : image.pixels)
            CHECK(p == glm::vec4(1.0f, 0.5f, 0.0f, 1.0f));
        checkTruncations(folder / name, folder / "cut.hdr", 1);
        checkMutations(folder / name, folder / "broken.hdr");
    }
}

TEST_CASE("Pictures: errors name the file and the reason")
{
    const TemporaryFolder folder;
    CHECK(errorOf(folder / "missing.png").find("missing.png") != std::string::npos);
    CHECK(errorOf(folder / "a.tiff").find("suffix") != std::string::npos);
    CHECK_THROWS_AS(decodeImage8({}, "nothing"), FileError);
    CHECK_THROWS_AS(decodeImage8(bytesOf("hello, world"), "text"), FileError);
    CHECK_THROWS_AS(saveImage(folder / "a.bmp", makeRamp(2, 2)), Error);
    CHECK_THROWS_AS(encodePng(CpuImage()), FileError);
}

TEST_CASE("Pictures: a claim of 60,000 x 60,000 is refused before any allocation")
{
    const TemporaryFolder folder;
    auto png = encodePng(makeRamp(4, 4));
    const std::uint8_t side[4] = {0x00, 0x00, 0xEA, 0x60}; // 60000, big endian, in the IHDR chunk
    std::memcpy(&png[16], side, 4);
    std::memcpy(&png[20], side, 4);
    CHECK_THROWS_AS(decodeImage8(png, "huge"), FileError);
    writeFileAtomically(folder / "huge.hdr",
                        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n\1\1\1\1");
    CHECK(errorOf(folder / "huge.hdr").find("60000 x 60000") != std::string::npos);
}

TEST_CASE("PNG: broken files are refused or decode, nothing else")
{
    const TemporaryFolder folder;
    savePng(folder / "good.png", makeRamp(20, 20));
    checkMutations(folder / "good.png", folder / "broken.png");
}

TEST_CASE("Pictures: reference data loads")
{
    struct Expected
    {
        const char* path;
        std::uint32_t width;
        std::uint32_t height;
    };
    for (const Expected& e :
         {Expected{"reference/cornell_lambert_cycles.exr", 320, 240},
          Expected{"env/polyhaven_lobby.exr", 512, 256}, Expected{"env/std_env.hdr", 1500, 750},
          Expected{"env/spruit_sunrise_1k.hdr", 1024, 512}}) {
        const fs::path path = fs::path(test::dataFolder()) / e.path;
        if (!fs::exists(path)) {
            MESSAGE("skipped, absent: " << e.path);
            continue;
        }
        const CpuImage image = loadImage(path);
        CHECK(image.width == e.width);
        CHECK(image.height == e.height);
        glm::dvec3 sum(0.0);
        for (const glm::vec4& p : image.pixels)
            sum += glm::dvec3(p);
        sum /= static_cast<double>(image.pixels.size());
        MESSAGE(std::string(e.path) << " mean " << sum.x << " " << sum.y << " " << sum.z);
        for (int c = 0; c < 3; ++c) {
            CHECK(std::isfinite(sum[c]));
            CHECK(sum[c] > 0.01);
        }
    }
}
