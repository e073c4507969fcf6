#include "tests/unit/atlas_checks.hpp"
#include "engine/base/error.hpp"

#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "shaders/shared/rng.h"

namespace strandlight::test {

namespace {

// Rounding of uv to fp32 at 512 texels is 3e-5; lookups give neighbours up to that weight.
constexpr float kLeastWeight = 2e-3f;

} // namespace

void addTriangle(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 c)
{
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    const glm::vec3 cross = glm::cross(b - a, c - a);
    const float length = glm::length(cross);
    for (const glm::vec3 p : {a, b, c}) {
        Vertex vertex;
        vertex.position = p;
        vertex.normal = length > 0.0f ? cross / length : glm::vec3(0.0f, 1.0f, 0.0f);
        scene.vertices.push_back(vertex);
    }
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.triangleMaterials.push_back(0);
}

void addQuad(Scene& scene, glm::vec3 corner, glm::vec3 u, glm::vec3 v)
{
    addTriangle(scene, corner, corner + u, corner + u + v);
    addTriangle(scene, corner, corner + u + v, corner + v);
}

Scene makeCube()
{
    Scene scene;
    const glm::vec3 x(1, 0, 0);
    const glm::vec3 y(0, 1, 0);
    const glm::vec3 z(0, 0, 1);
    addQuad(scene, {0, 0, 0}, y, x);
    addQuad(scene, {0, 0, 1}, x, y);
    addQuad(scene, {0, 0, 0}, x, z);
    addQuad(scene, {0, 1, 0}, z, x);
    addQuad(scene, {0, 0, 0}, z, y);
    addQuad(scene, {1, 0, 0}, y, z);
    return scene;
}

Scene makeSphere(int rings, int sectors)
{
    Scene scene;
    const auto point = [&](int ring, int sector) {
        const float theta = 3.14159265f * static_cast<float>(ring) / static_cast<float>(rings);
        const float phi =
            6.2831853f * static_cast<float>(sector % sectors) / static_cast<float>(sectors);
        return glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                         std::sin(theta) * std::sin(phi));
    };
    for (int r = 0; r < rings; ++r) {
        for (int s = 0; s < sectors; ++s) {
            if (r > 0)
                addTriangle(scene, point(r, s), point(r, s + 1), point(r + 1, s + 1));
            if (r + 1 < rings)
                addTriangle(scene, point(r, s), point(r + 1, s + 1), point(r + 1, s));
        }
    }
    for (Vertex& vertex : scene.vertices)
        vertex.normal = glm::normalize(vertex.position);
    return scene;
}

Scene makeSoup(std::uint32_t count, std::uint32_t seed)
{
    Scene scene;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto draw = [&](std::uint32_t k) { return gpu::uniform3(i, k, 0, seed); };
        const glm::vec3 centre = draw(0) * 5.0f;
        addTriangle(scene, centre + draw(1), centre + draw(2), centre + draw(3));
    }
    return scene;
}

glm::vec2 uvAt(const Atlas& atlas, std::uint32_t triangle, glm::vec2 weights)
{
    const AtlasCorner* c = &atlas.corners[std::size_t(triangle) * 3];
    return c[0].uv * (1.0f - weights.x - weights.y) + c[1].uv * weights.x + c[2].uv * weights.y;
}

std::vector<std::uint32_t> chartsOfTriangles(const Scene& scene, const Atlas& atlas)
{
    std::vector<std::uint32_t> chartOf(scene.triangles.size(), ~0u);
    for (const AtlasTexel& texel : atlas.texels)
        chartOf[texel.triangle] = texel.chart;
    return chartOf;
}

void checkLookups(const Scene& scene, const Atlas& atlas, std::uint32_t pointsPerTriangle)
{
    const std::vector<std::uint32_t> map = atlasTexelMap(atlas);
    const std::vector<std::uint32_t> chartOf = chartsOfTriangles(scene, atlas);
    std::size_t missing = 0;
    std::size_t foreign = 0;
    std::size_t mixed = 0;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::uvec3 i = scene.triangles[t];
        const glm::vec3 a = scene.vertices[i.x].position;
        if (glm::cross(scene.vertices[i.y].position - a, scene.vertices[i.z].position - a) ==
            glm::vec3(0.0f))
            continue;
        std::uint32_t chart = chartOf[t];
        for (std::uint32_t k = 0; k < pointsPerTriangle; ++k) {
            const glm::vec3 r = gpu::uniform3(t, k, 1, 7);
            const float root = std::sqrt(r.x);
            // The three corners first, then the inside.
            const std::array<glm::vec2, 3> corners = {glm::vec2(0), glm::vec2(1, 0),
                                                      glm::vec2(0, 1)};
            const glm::vec2 weights =
                k < 3 ? corners[k] : glm::vec2(root * (1.0f - r.y), root * r.y);
            const glm::vec2 p = uvAt(atlas, t, weights) - 0.5f;
            const glm::ivec2 base(glm::floor(p));
            const glm::vec2 f = p - glm::vec2(base);
            for (int corner = 0; corner < 4; ++corner) {
                const glm::ivec2 o(corner & 1, corner >> 1);
                const float weight = (o.x ? f.x : 1.0f - f.x) * (o.y ? f.y : 1.0f - f.y);
                if (weight < kLeastWeight)
                    continue;
                const glm::ivec2 q = base + o;
                const int side = static_cast<int>(atlas.resolution);
                const bool inside = q.x >= 0 && q.y >= 0 && q.x < side && q.y < side;
                const std::uint32_t texel =
                    inside ? map[static_cast<std::size_t>(q.y * side + q.x)] : kNoTexel;
                missing += texel == kNoTexel;
                if (texel == kNoTexel)
                    continue;
                if (chart == ~0u)
                    chart = atlas.texels[texel].chart;
                foreign += atlas.texels[texel].chart != chart;
                mixed += atlas.texels[texel].chart >= atlas.chartCount;
            }
        }
    }
    CHECK(missing == 0);
    CHECK(foreign == 0);
    CHECK(mixed == 0);
}

void checkTexels(const Scene& scene, const Atlas& atlas)
{
    REQUIRE(atlas.corners.size() == scene.triangles.size() * 3);
    REQUIRE(!atlas.texels.empty());
    for (std::size_t i = 0; i < atlas.texels.size(); ++i) {
        const AtlasTexel& t = atlas.texels[i];
        const std::uint32_t index = t.y * atlas.resolution + t.x;
        if (i > 0)
            REQUIRE(index > atlas.texels[i - 1].y * atlas.resolution + atlas.texels[i - 1].x);
        REQUIRE(t.barycentric.x >= 0.0f);
        REQUIRE(t.barycentric.y >= 0.0f);
        REQUIRE(t.barycentric.x + t.barycentric.y <= 1.0f + 1e-6f);
        const glm::vec2 centre(static_cast<float>(t.x) + 0.5f, static_cast<float>(t.y) + 0.5f);
        REQUIRE(glm::distance(uvAt(atlas, t.triangle, t.barycentric), centre) < 1.42f + 0.1f);
        const AtlasPoint p = evaluateAtlasTexel(scene, atlas, t);
        REQUIRE(std::abs(glm::length(p.n) - 1.0f) < 1e-5f);
        REQUIRE(std::abs(glm::length(p.t) - 1.0f) < 1e-5f);
        REQUIRE(std::abs(glm::dot(p.n, p.t)) < 1e-5f);
        REQUIRE(glm::distance(glm::cross(p.n, p.t), p.b) < 1e-5f);
        REQUIRE(glm::dot(p.geometricNormal, p.n) >= 0.0f);
    }
}

void checkAll(const Scene& scene, std::uint32_t resolution, std::uint32_t pointsPerTriangle)
{
    CAPTURE(resolution);
    const Atlas atlas = buildAtlas(scene, {.resolution = resolution, .gutter = 2});
    checkTexels(scene, atlas);
    checkLookups(scene, atlas, pointsPerTriangle);
}

double uvAreaOf(const Atlas& atlas, std::uint32_t t)
{
    const AtlasCorner* c = &atlas.corners[std::size_t(t) * 3];
    const glm::dvec2 ab(c[1].uv - c[0].uv);
    const glm::dvec2 ac(c[2].uv - c[0].uv);
    return 0.5 * (ab.x * ac.y - ab.y * ac.x);
}

double areaOf(const Scene& scene, std::uint32_t t)
{
    const glm::uvec3 i = scene.triangles[t];
    const glm::dvec3 a(scene.vertices[i.x].position);
    return 0.5 * glm::length(glm::cross(glm::dvec3(scene.vertices[i.y].position) - a,
                                        glm::dvec3(scene.vertices[i.z].position) - a));
}

std::string errorOf(const Scene& scene, std::uint32_t resolution)
{
    try {
        buildAtlas(scene, {.resolution = resolution, .gutter = 2});
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

} // namespace strandlight::test
