// The atlas: what a bilinear lookup can touch is listed, belongs to one chart, and is sampled on
// the right triangle.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/base/log.hpp"
#include "engine/scene/atlas.hpp"
#include "engine/scene/scene_loader.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/unit/atlas_checks.hpp"

using namespace strandlight;
using namespace strandlight::test;

TEST_CASE("atlas: cube, six charts, faces keep their shape")
{
    const Scene scene = makeCube();
    for (const std::uint32_t resolution : {16u, 33u, 64u, 256u})
        checkAll(scene, resolution, 200);
    const Atlas atlas = buildAtlas(scene, {.resolution = 64, .gutter = 2});
    CHECK(atlas.chartCount == 6);
    for (std::uint32_t t = 0; t < 12; ++t) {
        // Borders are moved to texel centres: a side of n texels changes by half a texel at most.
        const double expected = areaOf(scene, t) * atlas.texelsPerMetre * atlas.texelsPerMetre;
        CHECK(uvAreaOf(atlas, t) == doctest::Approx(expected).epsilon(0.07));
    }
    CHECK(atlas.texels.size() > 64 * 64 / 2);
}

TEST_CASE("atlas: two texels of gutter between charts")
{
    const Scene scene = makeCube();
    const Atlas atlas = buildAtlas(scene, {.resolution = 48, .gutter = 2});
    const std::vector<std::uint32_t> map = atlasTexelMap(atlas);
    const int side = 48;
    std::size_t close = 0;
    for (const AtlasTexel& t : atlas.texels)
        for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx) {
                const int x = static_cast<int>(t.x) + dx;
                const int y = static_cast<int>(t.y) + dy;
                if (x < 0 || y < 0 || x >= side || y >= side)
                    continue;
                const std::uint32_t other = map[static_cast<std::size_t>(y * side + x)];
                close += other != kNoTexel && atlas.texels[other].chart != t.chart;
            }
    CHECK(close == 0);
}

TEST_CASE("atlas: sphere, distortion stays within the cone's bound")
{
    const Scene scene = makeSphere(24, 48);
    checkAll(scene, 64);
    checkAll(scene, 256);
    const Atlas atlas = buildAtlas(scene, {.resolution = 256, .gutter = 2});
    CHECK(atlas.chartCount >= 4);
    CHECK(atlas.chartCount <= 60);
    const double scale = double(atlas.texelsPerMetre) * atlas.texelsPerMetre;
    double sum = 0.0;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const double ratio = uvAreaOf(atlas, t) / (areaOf(scene, t) * scale);
        // cos 50 degrees = 0.64 for the projection; rounding of narrow charts to whole texels takes
        // or adds the rest.
        CHECK(ratio > 0.3);
        CHECK(ratio < 2.0);
        sum += ratio;
    }
    CHECK(sum / static_cast<double>(scene.triangles.size()) == doctest::Approx(0.9).epsilon(0.15));
}

TEST_CASE("atlas: inside texels map to the surface point under their centre")
{
    Scene scene;
    addQuad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    const Atlas atlas = buildAtlas(scene, {.resolution = 32, .gutter = 2});
    CHECK(atlas.chartCount == 1);
    REQUIRE(atlas.texels.size() == 32 * 32);
    const AtlasPoint corner = evaluateAtlasTexel(scene, atlas, atlas.texels[0]);
    for (const AtlasTexel& t : atlas.texels) {
        if (t.x == 0 || t.y == 0 || t.x == 31 || t.y == 31)
            continue;
        const glm::vec2 centre(static_cast<float>(t.x) + 0.5f, static_cast<float>(t.y) + 0.5f);
        CHECK(glm::distance(uvAt(atlas, t.triangle, t.barycentric), centre) < 1e-4f);
        // Neighbouring texels are 2 m / 31 apart along the tangent of growing u.
        const AtlasPoint p = evaluateAtlasTexel(scene, atlas, t);
        const float u = glm::dot(p.position - corner.position, p.t);
        const float v = glm::dot(p.position - corner.position, p.b);
        CHECK(u ==
              doctest::Approx(static_cast<float>(t.x) * 2.0f / 31.0f).epsilon(0.02).scale(1.0));
        CHECK(v ==
              doctest::Approx(static_cast<float>(t.y) * 2.0f / 31.0f).epsilon(0.02).scale(1.0));
    }
    // Border samples lie strictly inside, so they are not in the plane of an adjoining wall.
    CHECK(std::abs(corner.position.x) < 1.0f - 1e-3f);
    CHECK(std::abs(corner.position.z) < 1.0f - 1e-3f);
}

TEST_CASE("atlas: the same scene gives the same atlas")
{
    const Scene scene = makeSoup(500, 5);
    const Atlas a = buildAtlas(scene, {.resolution = 100, .gutter = 2});
    const Atlas b = buildAtlas(scene, {.resolution = 100, .gutter = 2});
    REQUIRE(a.texels.size() == b.texels.size());
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        CHECK(a.texels[i].triangle == b.texels[i].triangle);
        CHECK(a.texels[i].barycentric == b.texels[i].barycentric);
    }
    for (std::size_t i = 0; i < a.corners.size(); ++i) {
        CHECK(a.corners[i].uv == b.corners[i].uv);
        CHECK(a.corners[i].tangent == b.corners[i].tangent);
    }
}

TEST_CASE("atlas: refusals name what is wrong")
{
    CHECK(errorOf(makeCube(), 2).find("6 charts") != std::string::npos);
    CHECK(errorOf(makeCube(), 0).find("resolution of 0") != std::string::npos);
    CHECK(errorOf(makeCube(), 100000).find("100000") != std::string::npos);
    Scene broken = makeCube();
    broken.vertices[5].position.y = std::numeric_limits<float>::quiet_NaN();
    CHECK(errorOf(broken, 32).find("vertex 5") != std::string::npos);
    Scene index = makeCube();
    index.triangles[3].y = 999;
    CHECK(errorOf(index, 32).find("999") != std::string::npos);
}

TEST_CASE("atlas: TEXCOORD_1 is used when valid, and refused when it overlaps, leaves the square "
          "or mixes texels")
{
    Scene scene;
    addQuad(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    addQuad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const std::array<glm::vec2, 6> square = {glm::vec2(0, 0), {1, 0}, {1, 1},
                                             {0, 0},          {1, 1}, {0, 1}};
    const auto setUv = [&](glm::vec2 first, glm::vec2 second, float size) {
        for (std::size_t i = 0; i < 6; ++i) {
            scene.vertices[i].uv1 = first + square[i] * size;
            scene.vertices[i + 6].uv1 = second + square[i] * size;
        }
    };
    scene.hasTexCoord1 = true;
    const auto build = [&] { return buildAtlas(scene, {.resolution = 64, .gutter = 2}); };
    std::string note;
    setLogLevel(LogLevel::Info);
    const LogSink previous = setLogSink([&](LogLevel, const std::string& text) { note = text; });

    setUv({0.02f, 0.02f}, {0.55f, 0.02f}, 0.4f);
    const Atlas good = build();
    CHECK(good.usedTexCoord1);
    CHECK(good.chartCount == 2);
    checkTexels(scene, good);
    checkLookups(scene, good, 300);
    // u runs along the first edge of the quad.
    CHECK(glm::distance(good.corners[0].tangent, glm::vec3(0, 0, 1)) < 1e-5f);
    CHECK(glm::distance(good.corners[6].tangent, glm::vec3(1, 0, 0)) < 1e-5f);

    setUv({0.02f, 0.02f}, {0.3f, 0.02f}, 0.4f); // overlap
    CHECK(!build().usedTexCoord1);
    CHECK(note.find("share the texel") != std::string::npos);
    setUv({0.02f, 0.02f}, {0.425f, 0.02f}, 0.4f); // a third of a texel between
    CHECK(!build().usedTexCoord1);
    setUv({0.02f, 0.02f}, {0.7f, 0.02f}, 0.4f); // beyond 1
    CHECK(!build().usedTexCoord1);
    setUv({0.02f, 0.02f}, {0.55f, 0.02f}, 0.0f); // no area
    CHECK(!build().usedTexCoord1);
    setLogSink(previous);
}

TEST_CASE("atlas: reference scenes")
{
    for (const char* name :
         {"scenes/cornell_lambert.gltf", "scenes/room.glb", "scenes/living_room.glb"}) {
        if (!std::filesystem::exists(test::dataFolder() + "/" + name)) {
            MESSAGE("skipped, absent: " << std::string(name));
            continue;
        }
        CAPTURE(name);
        const Scene scene = loadScene(test::dataFolder() + "/" + name);
        for (const std::uint32_t resolution : {64u, 128u, 256u})
            checkAll(scene, resolution, 6);
    }
}

TEST_CASE("atlas: the built-in room uses more than half of the texels")
{
    const Scene scene = loadScene("builtin:room");
    checkAll(scene, 64);
    const Atlas atlas = buildAtlas(scene, {.resolution = 128, .gutter = 2});
    CHECK(atlas.texels.size() > 128 * 128 / 2);
}
