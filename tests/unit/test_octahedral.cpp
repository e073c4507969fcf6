// Direction maps: round trips, and solid angles that add up.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

#include <doctest/doctest.h>

#include "shaders/shared/octahedral.h"
#include "shaders/shared/rng.h"

using namespace strandlight::gpu;

TEST_CASE("octahedral: directions survive encoding")
{
    float worst = 0.0f;
    for (uint i = 0; i < 20000; ++i) {
        const vec3 u = uniform3(i, 0, 0, 7);
        const float z = 2.0f * u.x - 1.0f;
        const float r = std::sqrt(1.0f - z * z);
        const vec3 d(r * std::cos(6.2831853f * u.y), r * std::sin(6.2831853f * u.y), z);
        worst = std::max(worst, length(octDecode(octEncode(d)) - d));
        const vec3 up(d.x, d.y, std::abs(d.z));
        worst = std::max(worst, length(hemiOctDecode(hemiOctEncode(up)) - up));
    }
    CHECK(worst < 1e-6f); // a few ulp: two multiplications and a normalisation
}

TEST_CASE("octahedral: pole in the centre, horizon on the border")
{
    CHECK(length(hemiOctDecode(vec2(0.5f)) - vec3(0.0f, 0.0f, 1.0f)) < 1e-6f);
    CHECK(hemiOctDecode(vec2(0.0f, 0.3f)).z == doctest::Approx(0.0).epsilon(1e-6));
    CHECK(hemiOctDecode(vec2(0.7f, 1.0f)).z == doctest::Approx(0.0).epsilon(1e-6));
}

TEST_CASE("octahedral: solid angles sum to the hemisphere")
{
    for (const uint size : {1u, 2u, 3u, 8u, 16u, 32u, 64u}) {
        double sum = 0.0;
        for (uint y = 0; y < size; ++y)
            for (uint x = 0; x < size; ++x)
                sum += hemiOctSolidAngle(x, y, size);
        CAPTURE(size);
        CHECK(sum == doctest::Approx(2.0 * 3.14159265358979).epsilon(1e-6));
    }
}

TEST_CASE("octahedral: a cell's solid angle is its share of uniform directions")
{
    // 2^20 stratified points on the hemisphere; the count in a cell of 1/256 of the area has sigma
    // < 1.6 %.
    constexpr uint kSize = 16;
    std::vector<int> count(kSize * kSize, 0);
    constexpr uint kSide = 1024;
    for (uint j = 0; j < kSide; ++j)
        for (uint i = 0; i < kSide; ++i) {
            const float z = (float(i) + 0.5f) / kSide;
            const float phi = 6.2831853f * (float(j) + 0.5f) / kSide;
            const float r = std::sqrt(1.0f - z * z);
            const vec2 uv = hemiOctEncode(vec3(r * std::cos(phi), r * std::sin(phi), z));
            const uint x = std::min(uint(uv.x * kSize), kSize - 1);
            const uint y = std::min(uint(uv.y * kSize), kSize - 1);
            ++count[y * kSize + x];
        }
    float worst = 0.0f;
    for (uint y = 0; y < kSize; ++y)
        for (uint x = 0; x < kSize; ++x) {
            const float expected =
                hemiOctSolidAngle(x, y, kSize) / 6.2831853f * float(kSide) * kSide;
            worst = std::max(worst, std::abs(float(count[y * kSize + x]) / expected - 1.0f));
        }
    CHECK(worst < 0.03f);
}
