// Hair files: good ones, and one defect at a time.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>

#include <doctest/doctest.h>

#include "engine/base/byte_stream.hpp"
#include "engine/base/error.hpp"
#include "engine/scene/hair_loader.hpp"
#include "shaders/shared/rng.h"
#include "tests/support/gltf_maker.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

using Bytes = std::vector<std::uint8_t>;

template <class T> void put(Bytes& bytes, std::size_t at, T value)
{
    REQUIRE(at + sizeof(T) <= bytes.size());
    std::memcpy(bytes.data() + at, &value, sizeof(T));
}

// Three strands of four points that go up by 0.1 each.
Bytes tfx()
{
    ByteWriter w;
    w.value(4.0f);
    for (const std::uint32_t v : {3u, 4u, 160u})
        w.value(v);
    for (int i = 0; i < 36; ++i)
        w.value(0u);
    for (int s = 0; s < 3; ++s)
        for (int i = 0; i < 4; ++i)
            w.value(glm::vec4(0.1f * float(s), 0.1f * float(i), 0.0f, i < 2 ? 0.0f : 1.0f));
    return w.bytes();
}

// The same with `flags`; two strands of four points and one of two when segments are an array.
Bytes hair(std::uint32_t flags)
{
    ByteWriter w;
    const bool isRagged = flags & 1;
    const std::vector<std::uint16_t> segments =
        isRagged ? std::vector<std::uint16_t>{3, 3, 1} : std::vector<std::uint16_t>{3, 3, 3};
    const std::uint32_t points = isRagged ? 10 : 12;
    w.value(std::uint32_t(0x52494148)); // "HAIR"
    for (const std::uint32_t v : {3u, points, flags, 3u})
        w.value(v);
    for (const float v : {0.002f, 0.25f, 0.6f, 0.3f, 0.1f})
        w.value(v);
    for (int i = 0; i < 22; ++i)
        w.value(0u);
    if (isRagged)
        for (const std::uint16_t s : segments)
            w.value(s);
    for (int s = 0; s < 3; ++s)
        for (int i = 0; i <= segments[std::size_t(s)]; ++i)
            w.value(glm::vec3(0.1f * float(s), 0.1f * float(i), 0.0f));
    for (std::uint32_t i = 0; i < points && (flags & 4); ++i)
        w.value(0.001f * float(i + 1));
    for (std::uint32_t i = 0; i < points && (flags & 8); ++i)
        w.value(0.5f);
    for (std::uint32_t i = 0; i < points && (flags & 16); ++i)
        w.value(glm::vec3(0.05f * float(i), 0.5f, 1.0f));
    return w.bytes();
}

// The reason why a file is refused; "" when it is not.
std::string refusal(const Bytes& bytes, const std::string& name)
{
    try {
        checkHair(decodeHair(bytes, name));
    } catch (const FileError& error) {
        const std::string text = error.what();
        CHECK(text.find(name + ": ") == 0);
        return text.substr(name.size());
    }
    return "";
}

template <class T> std::string refusedTfx(std::size_t at, T value)
{
    Bytes bytes = tfx();
    put(bytes, at, value);
    return refusal(bytes, "broken.tfx");
}

template <class T> std::string refusedHair(std::uint32_t flags, std::size_t at, T value)
{
    Bytes bytes = hair(flags);
    put(bytes, at, value);
    return refusal(bytes, "broken.hair");
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("a .tfx file")
{
    const test::TemporaryFolder folder;
    const HairStrands strands =
        loadHair(folder.write("three.tfx", tfx())); // the way through a file
    REQUIRE_NOTHROW(checkHair(strands));
    CHECK(strands.name == "three");
    CHECK(strands.firstPoint == std::vector<std::uint32_t>{0, 4, 8, 12});
    CHECK(strands.segmentCount() == 9);
    CHECK(strands.points[6] == glm::vec3(0.1f, 0.2f, 0.0f));
    CHECK(strands.boundsMax() == glm::vec3(0.2f, 0.3f, 0.0f));
    // 1e-4 of the diagonal, and a tenth of it at the tip.
    CHECK(strands.radii[0] == doctest::Approx(1e-4 * std::sqrt(0.13)));
    CHECK(strands.radii[3] == doctest::Approx(1e-5 * std::sqrt(0.13)));
    CHECK(strands.colors[0] != strands.colors[4]);
}

TEST_CASE("a .hair file with every combination of its arrays")
{
    for (std::uint32_t flags = 2; flags < 32; flags = (flags + 1) | 2) {
        CAPTURE(flags);
        const HairStrands strands = decodeHair(hair(flags), "three.hair");
        REQUIRE_NOTHROW(checkHair(strands));
        const bool isRagged = flags & 1;
        CHECK(strands.firstPoint == (isRagged ? std::vector<std::uint32_t>{0, 4, 8, 10}
                                              : std::vector<std::uint32_t>{0, 4, 8, 12}));
        CHECK(strands.points[9] == glm::vec3(0.2f, 0.1f, 0.0f));
        if (flags & 4)
            CHECK(strands.radii[3] == 0.5f * (0.001f * 4.0f)); // given: no taper
        else
            CHECK(strands.radii[3] == doctest::Approx(0.0001f)); // a tenth of the radius
        if (flags & 16)
            CHECK(strands.colors[2] == glm::vec3(0.05f * 2.0f, 0.5f, 1.0f));
        else
            CHECK(strands.colors[0] != strands.colors[4]);
    }
}

TEST_CASE("broken .tfx files are refused with the place")
{
    CHECK(contains(refusedTfx(0, 3.0f), "byte 0: version 3.000000 is not TressFX 4"));
    CHECK(contains(refusedTfx(0, std::nanf("")), "byte 0: version"));
    CHECK(contains(refusedTfx(4, 0u), "byte 4: 0 strands of 4 points"));
    CHECK(contains(refusedTfx(8, 1u), "byte 4: 3 strands of 1 points"));
    CHECK(contains(refusedTfx(4, 4u), "byte 12: 4 strands of 4 points at byte 160 do not fit"));
    // 2^32 - 1 strands of 2^32 - 1 points: the product must not wrap.
    Bytes huge = tfx();
    put(huge, 4, 0xffffffffu);
    put(huge, 8, 0xffffffffu);
    CHECK(contains(refusal(huge, "huge.tfx"), "do not fit"));
    CHECK(contains(refusedTfx(12, 8u), "byte 12:"));          // inside of the header
    CHECK(contains(refusedTfx(12, 0xfffffff0u), "byte 12:")); // behind the end
    CHECK(contains(refusedTfx(160 + 16 * 5 + 4, std::nanf("")), "point 5: the coordinate"));
    CHECK(contains(refusedTfx(160 + 16 * 5 + 4, 1e30f), "point 5: the coordinate"));
    CHECK(contains(refusal(Bytes(100), "short.tfx"), "bytes are needed"));
    CHECK(contains(refusal({}, "empty.tfx"), "bytes are needed"));
    CHECK(contains(refusal(tfx(), "named.obj"), "byte 0: is neither"));
    CHECK_THROWS_AS(loadHair("no/such/file.hair"), FileError);
}

TEST_CASE("broken .hair files are refused with the place")
{
    CHECK(contains(refusedHair(2, 4, 0u), "byte 4: no strand"));
    CHECK(contains(refusedHair(2, 4, 4u), "byte 4: 4 strands of 3 segments do not have 12 points"));
    CHECK(contains(refusedHair(2, 4, 0x40000003u), "byte 4:")); // x 4 wraps to 12 in 32 bits
    CHECK(contains(refusedHair(2, 8, 13u), "do not have 13 points"));
    CHECK(contains(refusedHair(2, 12, 0u), "byte 12: no array of points"));
    CHECK(contains(refusedHair(2, 12, 34u), "byte 12: unknown flags 32"));
    CHECK(contains(refusedHair(2, 12, 6u), "byte 272: 12 elements are claimed, 0 bytes are left"));
    CHECK(contains(refusedHair(2, 16, 0u), "byte 4: 3 strands of 0 segments"));
    CHECK(contains(refusedHair(2, 20, -1.0f), "byte 20: a thickness of -1"));
    CHECK(contains(refusedHair(2, 24, 2.0f), "byte 24: a transparency of 2"));
    CHECK(contains(refusedHair(2, 32, std::nanf("")), "byte 28: a colour of nan"));
    CHECK(contains(refusedHair(3, 130, std::uint16_t(0)), "strand 1: no segment"));
    CHECK(contains(refusedHair(3, 130, std::uint16_t(2)), "byte 8: the strands do not have 10"));
    CHECK(contains(refusedHair(3, 130, std::uint16_t(65535)), "byte 8: the strands do not have"));
    CHECK(contains(refusedHair(3, 4, 0xffffffffu), "4294967295 elements are claimed"));
    CHECK(contains(refusedHair(3, 8, 0xffffffffu), "4294967295 points are claimed"));
    const float infinity = std::numeric_limits<float>::infinity();
    CHECK(contains(refusedHair(2, 128 + 12 * 7, infinity), "point 7: the coordinate inf"));
    const std::size_t behindPoints = 128 + 12 * 12;
    CHECK(contains(refusedHair(6, behindPoints + 4, -0.1f), "point 1: a thickness of -0.1"));
    CHECK(contains(refusedHair(10, behindPoints + 8, 1.5f), "point 2: a transparency of 1.5"));
    CHECK(contains(refusedHair(18, behindPoints + 36, 1.5f), "point 3: a colour of 1.5"));
    CHECK(contains(refusal({'H', 'A', 'I', 'R', 1}, "short.hair"), "bytes are needed"));
}

TEST_CASE("every truncated hair file is refused")
{
    for (const Bytes& whole : {tfx(), hair(31)})
        for (std::size_t size = 0; size < whole.size(); size += 3) {
            CAPTURE(size);
            const std::string name = whole[0] == 'H' ? "cut.hair" : "cut.tfx";
            CHECK_FALSE(
                refusal(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(size)), name).empty());
        }
}

TEST_CASE("bytes at random give hair that holds together or a FileError, nothing else")
{
    constexpr std::uint32_t kTries = 1500;
    std::uint32_t refused = 0;
    for (std::uint32_t n = 0; n < kTries; ++n) {
        CAPTURE(n);
        Bytes bytes = n % 3 == 0 ? tfx() : hair(n % 3 == 1 ? 31u : 2u);
        const std::string name = n % 3 == 0 ? "any.tfx" : "any.hair";
        const gpu::uvec3 h = gpu::hashPcg3(gpu::uvec3(n, 1u, 2u));
        for (std::uint32_t k = 0; k <= h.x % 4; ++k) {
            const gpu::uvec3 r = gpu::hashPcg3(gpu::uvec3(n, k, 3u));
            const std::size_t range = r.z % 2 ? bytes.size() : std::size_t(48); // headers, often
            bytes[r.x % range] = static_cast<std::uint8_t>(r.y);
        }
        refused += refusal(bytes, name).empty() ? 0 : 1;
    }
    CHECK(refused > kTries / 10);
    CHECK(refused < kTries);
}

TEST_CASE("a part of the strands is spread over all of them")
{
    const HairStrands whole = decodeHair(hair(3), "three.hair");
    const HairStrands part = selectStrands(whole, 2);
    REQUIRE_NOTHROW(checkHair(part));
    CHECK(part.firstPoint == std::vector<std::uint32_t>{0, 4, 8});
    CHECK(part.points[4] == whole.points[4]);
    CHECK(selectStrands(whole, 5).points.size() == whole.points.size());
}

TEST_CASE("checkHair names what does not belong together")
{
    const HairStrands good = decodeHair(tfx(), "three.tfx");
    HairStrands bad = good;
    bad.radii.pop_back();
    CHECK_THROWS_WITH_AS(checkHair(bad), "hair 'three': 12 points, 11 radii, 12 colours", Error);
    bad = good;
    bad.firstPoint = {0, 4, 5, 12};
    CHECK_THROWS_WITH_AS(checkHair(bad), "hair 'three': strand 1 has fewer than two points", Error);
    bad = good;
    bad.firstPoint.back() = 11;
    CHECK_THROWS_AS(checkHair(bad), Error);
    bad = good;
    bad.colors[3].x = 1.1f;
    CHECK_THROWS_AS(checkHair(bad), Error);
    CHECK_THROWS_AS(checkHair(HairStrands{}), Error);
}

TEST_CASE("real hair: both formats of one groom agree")
{
    const std::filesystem::path folder = std::filesystem::path(test::dataFolder()) / "hair";
    if (test::dataFolder().empty() || !std::filesystem::exists(folder / "ratboy_mohawk.tfx")) {
        MESSAGE("no hair files: skipped");
        return;
    }
    const HairStrands fromTfx = loadHair(folder / "ratboy_mohawk.tfx");
    const HairStrands fromHair = loadHair(folder / "ratboy_mohawk.hair");
    REQUIRE_NOTHROW(checkHair(fromTfx));
    REQUIRE_NOTHROW(checkHair(fromHair));
    CHECK(fromTfx.strandCount() == 2228);
    CHECK(fromTfx.points.size() == 2228 * 32);
    CHECK(fromTfx.points == fromHair.points);
    CHECK(fromTfx.firstPoint == fromHair.firstPoint);
    // The .hair file's thickness was made by the same rule, in double precision.
    for (std::size_t i = 0; i < fromTfx.radii.size(); i += 97)
        CHECK(fromTfx.radii[i] == doctest::Approx(fromHair.radii[i]).epsilon(1e-5));
    const HairStrands curly = loadHair(folder / "synthetic_curly.hair");
    REQUIRE_NOTHROW(checkHair(curly));
    CHECK(curly.strandCount() == 2000);
    CHECK(curly.segmentCount() == 2000 * 47);
}
