// Charts of difficult surfaces: too many for their texels, folded, without area, soups of
// triangles.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/scene/atlas.hpp"
#include "tests/unit/atlas_checks.hpp"

using namespace strandlight;
using namespace strandlight::test;

TEST_CASE("atlas: random soups of every size")
{
    for (const std::uint32_t count : {1u, 2u, 3u, 17u, 100u, 1000u})
        checkAll(makeSoup(count, count), 64);
}

TEST_CASE("atlas: more charts than texels still work, sharing texels by place and direction")
{
    const Scene scene = makeSoup(6000, 3);
    const Atlas atlas = buildAtlas(scene, {.resolution = 64, .gutter = 2});
    checkTexels(scene, atlas);
    checkLookups(scene, atlas, 4);
    CHECK(atlas.chartCount < 4096);
}

TEST_CASE("atlas: when charts must share texels, the smallest do")
{
    // 36 boxes in a room: 222 charts, of which 128 may stay.
    Scene scene = makeCube();
    for (Vertex& vertex : scene.vertices)
        vertex.position *= 4.0f;
    const Scene box = makeCube();
    for (int i = 0; i < 36; ++i)
        for (const glm::uvec3 t : box.triangles) {
            const auto corner = [&](std::uint32_t v) {
                return 0.1f * box.vertices[v].position +
                       glm::vec3(float(i % 6) - 2.5f, -2.0f, float(i / 6) - 2.5f);
            };
            addTriangle(scene, corner(t.x), corner(t.y), corner(t.z));
        }
    const Atlas atlas = buildAtlas(scene, {.resolution = 64, .gutter = 2});
    checkTexels(scene, atlas);
    checkLookups(scene, atlas, 10);
    CHECK(atlas.chartCount <= 128);
    CHECK(atlas.chartCount > 100);
    CHECK(atlas.chartCount + atlas.sharingCharts == 222);
    for (std::uint32_t t = 0; t < 12; ++t) { // the walls keep their texels
        const double expected = areaOf(scene, t) * atlas.texelsPerMetre * atlas.texelsPerMetre;
        CHECK(expected > 20.0);
        CHECK(uvAreaOf(atlas, t) == doctest::Approx(expected).epsilon(0.2));
    }
}

TEST_CASE("atlas: triangles without area are carried along")
{
    Scene scene = makeCube();
    addTriangle(scene, {0, 0, 0}, {0, 0, 0}, {1, 0, 0});
    addTriangle(scene, {0, 0, 0}, {0.5f, 0, 0}, {1, 0, 0});
    addTriangle(scene, {7, 7, 7}, {7, 7, 7}, {7, 7, 7});
    checkAll(scene, 32);
    Scene empty;
    addTriangle(empty, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
    CHECK(errorOf(empty, 32).find("area") != std::string::npos);
    CHECK(errorOf(Scene(), 32).find("no triangles") != std::string::npos);
}

TEST_CASE("atlas: a surface that folds over itself is cut")
{
    // A helix of two and a half turns whose normals all point up: a plain projection would cover
    // itself.
    Scene scene;
    const auto point = [](int i, float radius) {
        const float angle = 0.15f * static_cast<float>(i);
        return glm::vec3(radius * std::cos(angle), 0.02f * static_cast<float>(i),
                         -radius * std::sin(angle));
    };
    for (int i = 0; i < 105; ++i) {
        addTriangle(scene, point(i, 1.0f), point(i, 2.0f), point(i + 1, 2.0f));
        addTriangle(scene, point(i, 1.0f), point(i + 1, 2.0f), point(i + 1, 1.0f));
    }
    const Atlas atlas = buildAtlas(scene, {.resolution = 128, .gutter = 2});
    checkTexels(scene, atlas);
    checkLookups(scene, atlas, 40);
    CHECK(atlas.chartCount >= 3);
    // No two triangles lie over each other: a raster of the uv sees each place once.
    std::vector<int> hits(512 * 512, 0);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
        for (std::uint32_t y = 0; y < 512; ++y)
            for (std::uint32_t x = 0; x < 512; ++x) {
                const AtlasCorner* c = &atlas.corners[std::size_t(t) * 3];
                const glm::vec2 p((static_cast<float>(x) + 0.5f) / 4.0f,
                                  (static_cast<float>(y) + 0.5f) / 4.0f);
                bool inside = true;
                for (int e = 0; e < 3 && inside; ++e) {
                    const glm::vec2 a = c[e].uv;
                    const glm::vec2 d = c[(e + 1) % 3].uv - a;
                    inside = (d.x * (p.y - a.y) - d.y * (p.x - a.x)) > 0.02f * glm::length(d);
                }
                hits[std::size_t(y) * 512 + x] += inside;
            }
    CHECK(*std::max_element(hits.begin(), hits.end()) == 1);
}
