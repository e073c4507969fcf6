// The hierarchy against brute force, on soups, shared edges and awkward scales.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "engine/base/error.hpp"
#include "engine/scene/bvh.hpp"
#include "shaders/shared/trace_types.h"

using namespace strandlight;

namespace {

Scene emptyScene()
{
    Scene scene;
    scene.materials.resize(1);
    return scene;
}

void addTriangle(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 c)
{
    const auto first = std::uint32_t(scene.vertices.size());
    for (const glm::vec3 p : {a, b, c}) {
        Vertex vertex;
        vertex.position = p;
        scene.vertices.push_back(vertex);
    }
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangleMaterials.push_back(0);
}

Scene randomSoup(int count, float size, float scale, glm::vec3 centre, std::uint32_t seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    const auto point = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    Scene scene = emptyScene();
    for (int i = 0; i < count; ++i) {
        const glm::vec3 p = point();
        addTriangle(scene, centre + scale * (p + size * point()),
                    centre + scale * (p + size * point()), centre + scale * (p + size * point()));
    }
    return scene;
}

// The same triangles in one leaf after the other: every triangle is tested.
gpu::Hit traceAll(const Bvh& bvh, glm::vec3 origin, glm::vec3 direction)
{
    gpu::Hit best{};
    best.t = std::numeric_limits<float>::max();
    best.slot = gpu::kNoHit;
    gpu::BvhGrid grid = bvh.grid;
    grid.nodeCount = 1;
    for (std::uint32_t slot = 0; slot < bvh.order.size(); ++slot) {
        const glm::uvec4 leaf(0xffff0000u, 0xffff0000u, 0xffff0000u,
                              gpu::kLeafBit | (slot << 3u) | 1u);
        const std::vector<glm::uvec4> nodes(8, leaf);
        const gpu::Hit hit = gpu::traverse({nodes.data(), bvh.triangles.data()}, grid, origin,
                                           direction, 0.0f, best.t, false);
        if (hit.slot != gpu::kNoHit)
            best = hit;
    }
    return best;
}

void compareWithBruteForce(const Scene& scene, float scale, glm::vec3 centre, int rays,
                           std::uint32_t seed)
{
    const Bvh bvh = buildBvh(scene);
    REQUIRE(bvh.order.size() == scene.triangles.size());
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    int hits = 0;
    int exact = 0;
    for (int i = 0; i < rays; ++i) {
        const auto point = [&] {
            return glm::vec3(normal(random), normal(random), normal(random));
        };
        const glm::vec3 origin = centre + scale * 2.0f * point();
        glm::vec3 direction = glm::normalize(centre + scale * 0.5f * point() - origin);
        if (i % 7 == 0) // axis-parallel rays take the guarded path of the slab test
            direction = glm::vec3(i % 3 == 0 ? -1 : 0, i % 3 == 1 ? -1 : 0, i % 3 == 2 ? -1 : 0);
        const float far = std::numeric_limits<float>::max();
        const gpu::Hit hit =
            gpu::traverse(bvh.view(), bvh.grid, origin, direction, 0.0f, far, false);
        const gpu::Hit expected = traceAll(bvh, origin, direction);
        REQUIRE_FALSE(hit.lost);
        REQUIRE((hit.slot == gpu::kNoHit) == (expected.slot == gpu::kNoHit));
        if (hit.slot == gpu::kNoHit)
            continue;
        ++hits;
        // The same arithmetic on the same triangle; but where a triangle is seen edge-on its own
        // distance is uncertain, and its box may be left before.
        exact += hit.t == expected.t ? 1 : 0;
        REQUIRE(std::abs(hit.t - expected.t) <= 1e-4f * scale);
        const gpu::Hit any =
            gpu::traverse(bvh.view(), bvh.grid, origin, direction, 0.0f, far, true);
        REQUIRE(any.slot != gpu::kNoHit);
        const gpu::Hit before =
            gpu::traverse(bvh.view(), bvh.grid, origin, direction, 0.0f, hit.t, true);
        REQUIRE(before.slot == gpu::kNoHit);
    }
    CHECK(hits > rays / 40);
    // Overlapping triangles of a flat scene tie, and either may win.
    CHECK(exact >= hits - hits / 10);
}

} // namespace

TEST_CASE("bvh: same hits as brute force")
{
    compareWithBruteForce(randomSoup(1, 0.5f, 1.0f, {}, 1), 1.0f, {}, 400, 2);
    compareWithBruteForce(randomSoup(5, 0.5f, 1.0f, {}, 3), 1.0f, {}, 400, 4);
    compareWithBruteForce(randomSoup(300, 0.3f, 1.0f, {}, 5), 1.0f, {}, 1000, 6);
    compareWithBruteForce(randomSoup(3000, 0.05f, 1.0f, {}, 7), 1.0f, {}, 200, 8);
}

TEST_CASE("bvh: tiny, huge, far and flat scenes")
{
    compareWithBruteForce(randomSoup(300, 0.3f, 1e-6f, {}, 1), 1e-6f, {}, 400, 2);
    compareWithBruteForce(randomSoup(300, 0.3f, 1e12f, {}, 3), 1e12f, {}, 400, 4);
    const glm::vec3 far(1000.0f, -2000.0f, 500.0f);
    compareWithBruteForce(randomSoup(300, 0.3f, 1.0f, far, 5), 1.0f, far, 400, 6);
    Scene flat = randomSoup(300, 0.3f, 1.0f, {}, 7);
    for (Vertex& vertex : flat.vertices)
        vertex.position.y = 0.25f;
    compareWithBruteForce(flat, 1.0f, {}, 400, 8);
}

TEST_CASE("bvh: boxes hold their triangles on the grid that rays know, also far from the origin")
{
    // At 1000 m fp32 steps are longer than those of the grid: an origin that is not rounded as the
    // rays' one is would shift the boxes by more than their slack.
    const glm::vec3 far(1000.1f, -2000.7f, 3.3f);
    const Bvh bvh = buildBvh(randomSoup(300, 0.3f, 1.0f, far, 5));
    for (const glm::uvec4& node : bvh.nodes) {
        if (node.w < gpu::kLeafBit)
            continue;
        const std::uint32_t first = (node.w & ~gpu::kLeafBit) >> 3u;
        for (std::uint32_t i = first; i < first + (node.w & 7u); ++i) {
            const TriangleCorners t = triangleCorners(bvh, i);
            for (const glm::vec3& p : {t.a, t.b, t.c})
                for (int axis = 0; axis < 3; ++axis) {
                    const double cell = (double(p[axis]) - double(bvh.grid.origin[axis])) *
                                        double(bvh.grid.inverseStep[axis]);
                    // Half of the step of slack must be left.
                    REQUIRE(cell >= (node[axis] & 0xFFFFu) + 0.5);
                    REQUIRE(cell <= (node[axis] >> 16u) - 0.5);
                }
        }
    }
}

TEST_CASE("bvh: degenerate input")
{
    // Five hundred times the same triangle, and points and needles among them.
    Scene scene = emptyScene();
    for (int i = 0; i < 500; ++i)
        addTriangle(scene, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
    addTriangle(scene, {0, 0, 1}, {0, 0, 1}, {0, 0, 1});
    addTriangle(scene, {0, 0, 1}, {0.5f, 0, 1}, {1, 0, 1});
    const Bvh bvh = buildBvh(scene);
    const gpu::Hit hit = gpu::traverse(bvh.view(), bvh.grid, {0, 0, 5}, {0, 0, -1}, 0, 1e9f, false);
    CHECK(hit.t == doctest::Approx(5.0f));
    CHECK(std::set<std::uint32_t>(bvh.order.begin(), bvh.order.end()).size() == 502);

    const Bvh none = buildBvh(emptyScene());
    CHECK(gpu::traverse(none.view(), none.grid, {}, {0, 0, 1}, 0, 1e9f, false).slot == gpu::kNoHit);

    scene.vertices[4].position.y = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_WITH_AS(buildBvh(scene), doctest::Contains("triangle 1, corner 1"), Error);
}

TEST_CASE("bvh: the same scene gives the same bytes, leaves are small")
{
    const Scene scene = randomSoup(2000, 0.1f, 1.0f, {}, 11);
    const Bvh a = buildBvh(scene);
    const Bvh b = buildBvh(scene);
    CHECK(a.nodes == b.nodes);
    CHECK(a.triangles == b.triangles);
    CHECK(a.nodes.size() == std::size_t(a.grid.nodeCount) * 8);
    for (const glm::uvec4& node : a.nodes)
        if (node.w >= gpu::kLeafBit)
            REQUIRE(((node.w & 7u) >= 1u && (node.w & 7u) <= gpu::kLeafTriangles));
}

TEST_CASE("bvh: no ray slips through the shared edges of a closed mesh")
{
    // A bumpy sphere of 2 x 64 x 32 triangles; rays from inside towards its vertices and edge
    // midpoints.
    constexpr int kAround = 64;
    constexpr int kUp = 32;
    const auto point = [](int i, int j) {
        const float phi = 6.2831853f * float(i % kAround) / kAround;
        const float theta = 3.1415927f * float(j) / kUp;
        const float r =
            j == 0 || j == kUp ? 1.0f : 1.0f + 0.1f * std::sin(5.0f * phi + 3.0f * theta);
        const float s = j == 0 || j == kUp ? 0.0f : std::sin(theta);
        return r * glm::vec3(s * std::cos(phi), std::cos(theta), s * std::sin(phi));
    };
    Scene scene = emptyScene();
    for (int j = 0; j < kUp; ++j)
        for (int i = 0; i < kAround; ++i) {
            addTriangle(scene, point(i, j), point(i + 1, j), point(i + 1, j + 1));
            addTriangle(scene, point(i, j), point(i + 1, j + 1), point(i, j + 1));
        }
    const Bvh bvh = buildBvh(scene);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    int leaks = 0;
    for (int n = 0; n < 20000; ++n) {
        const glm::vec3 origin(unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f);
        const int i = int(unit(random) * kAround);
        const int j = int(unit(random) * kUp);
        const int other = n % 3;
        const glm::vec3 a = point(i, j);
        const glm::vec3 b = point(other == 0 ? i : i + 1, other == 1 ? j : j + 1);
        const glm::vec3 target = glm::mix(a, b, n % 2 == 0 ? 0.0f : unit(random));
        const gpu::Hit hit = gpu::traverse(bvh.view(), bvh.grid, origin,
                                           glm::normalize(target - origin), 0.0f, 1e9f, n % 5 == 0);
        leaks += hit.slot == gpu::kNoHit ? 1 : 0;
    }
    CHECK(leaks == 0);
}
