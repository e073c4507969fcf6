// Samplers against their densities.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>

#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sampling.h"
#include "shaders/shared/trace_types.h"

using namespace strandlight;

TEST_CASE("sampling: cosine hemisphere has its moments")
{
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    constexpr int kCount = 200000;
    glm::dvec3 mean(0.0);
    double second = 0.0;
    for (int i = 0; i < kCount; ++i) {
        const glm::vec3 d = gpu::sampleCosineHemisphere(unit(random), unit(random));
        REQUIRE(std::abs(glm::length(d) - 1.0f) < 1e-5f);
        mean += glm::dvec3(d) / double(kCount);
        second += double(d.z) * d.z / kCount;
    }
    // E[z] = 2/3, E[z^2] = 1/2; sd of a mean is below 0.5 / sqrt(n) = 0.0011, five of them allowed.
    CHECK(std::abs(mean.x) < 0.0056);
    CHECK(std::abs(mean.y) < 0.0056);
    CHECK(std::abs(mean.z - 2.0 / 3.0) < 0.0056);
    CHECK(std::abs(second - 0.5) < 0.0056);
}

TEST_CASE("sampling: triangle points are uniform")
{
    // Sixteen congruent sub-triangles must get equal counts: chi-square with 15 degrees, p = 1e-4
    // at 44.3.
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    std::array<int, 16> counts{};
    constexpr int kCount = 160000;
    for (int i = 0; i < kCount; ++i) {
        const glm::vec2 p = gpu::sampleTriangle(unit(random), unit(random)) * 4.0f;
        REQUIRE(p.x >= 0.0f);
        REQUIRE(p.y >= 0.0f);
        REQUIRE(p.x + p.y <= 4.0001f);
        const int x = std::min(int(p.x), 3);
        const int y = std::min(int(p.y), 3 - x);
        const bool upper = (p.x - float(x)) + (p.y - float(y)) > 1.0f;
        // Row x holds 4 - x lower and 3 - x upper triangles.
        int index = 0;
        for (int row = 0; row < x; ++row)
            index += 2 * (4 - row) - 1;
        counts[std::size_t(std::min(index + 2 * y + (upper ? 1 : 0), 15))] += 1;
    }
    double chi = 0.0;
    for (const int count : counts)
        chi += std::pow(count - kCount / 16.0, 2.0) / (kCount / 16.0);
    CHECK(chi < 44.3);
}

TEST_CASE("sampling: heuristic weights add up to one")
{
    for (const float a : {1e-6f, 0.3f, 1.0f, 1e20f})
        for (const float b : {1e-6f, 0.3f, 1.0f, 1e20f})
            CHECK(gpu::powerHeuristic(a, b) + gpu::powerHeuristic(b, a) == doctest::Approx(1.0f));
    CHECK(gpu::powerHeuristic(1.0f, 0.0f) == 1.0f);
}

TEST_CASE("sampling: frames are orthonormal and right-handed")
{
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 1000; ++i) {
        glm::vec3 n = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        if (i < 6)
            n = glm::vec3(i / 2 == 0, i / 2 == 1, i / 2 == 2) * (i % 2 == 0 ? 1.0f : -1.0f);
        glm::vec3 x;
        glm::vec3 y;
        gpu::buildBasis(n, x, y);
        REQUIRE(glm::length(glm::cross(x, y) - n) < 1e-5f);
        REQUIRE(std::abs(glm::dot(x, x) - 1.0f) < 1e-5f);
        REQUIRE(std::abs(glm::dot(x, n)) < 1e-6f);
    }
}

TEST_CASE("rgb9e5: rounds to nearest, keeps the exact values, clamps the rest")
{
    std::mt19937 random(4);
    std::uniform_real_distribution<float> exponent(-18.0f, 15.9f);
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 c(std::exp2(exponent(random)), std::exp2(exponent(random)),
                          std::exp2(exponent(random)));
        const float brightest = std::max({c.x, c.y, c.z});
        const glm::vec3 back = gpu::unpackRgb9e5(gpu::packRgb9e5(c));
        // Half a step of the brightest channel's mantissa (at least 256 of 511), or of the smallest
        // exponent.
        const float bound = std::max(brightest / 256.0f, std::exp2(-24.0f)) * 0.5f;
        for (int k = 0; k < 3; ++k)
            REQUIRE(std::abs(back[k] - c[k]) <= bound * 1.0001f);
        REQUIRE(gpu::packRgb9e5(back) == gpu::packRgb9e5(c));
        REQUIRE_FALSE(gpu::rgb9e5Clamps(c));
    }
    CHECK(gpu::unpackRgb9e5(gpu::packRgb9e5(glm::vec3(1.0f, 0.5f, 0.0f))) ==
          glm::vec3(1.0f, 0.5f, 0.0f));
    CHECK(gpu::unpackRgb9e5(gpu::packRgb9e5(glm::vec3(0.0f))) == glm::vec3(0.0f));
    CHECK(gpu::unpackRgb9e5(gpu::packRgb9e5(glm::vec3(1e9f, 1.0f, -1.0f))).x == 65408.0f);
    CHECK(gpu::unpackRgb9e5(gpu::packRgb9e5(glm::vec3(65408.0f))) == glm::vec3(65408.0f));
    CHECK(gpu::rgb9e5Clamps(glm::vec3(1e9f, 1.0f, 1.0f)));
    CHECK(gpu::rgb9e5Clamps(glm::vec3(0.0f, std::nanf(""), 0.0f)));
}
