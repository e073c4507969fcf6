// FLIP against hand-computed values, against a plain implementation in double, and against what an
// eye sees. Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild. FLIP: A Difference
// Evaluator for Alternating Images. 2020
#include <cmath>

#include <doctest/doctest.h>

#include "engine/base/flip.hpp"
#include "tests/unit/metric_pictures.hpp"
#include "tests/unit/plain_flip.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

double flipOf(const CpuImage& a, const CpuImage& b)
{
    return meanOf(computeFlip(a, b));
}

// A sine along x of `cycles` per picture of 134 pixels (two degrees) around grey, in one direction
// of colour.
CpuImage grating(double cycles, glm::dvec3 amplitude)
{
    CpuImage image(134, 24);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const double wave = std::sin(2.0 * 3.14159265358979 * cycles * (x + 0.25) / 134.0);
            image.at(x, y) = glm::vec4(glm::vec3(glm::dvec3(0.3) + amplitude * wave), 1.0f);
        }
    return image;
}

double seen(double cycles, glm::dvec3 amplitude)
{
    return flipOf(grating(cycles, amplitude), grating(cycles, glm::dvec3(0.0)));
}

} // namespace

TEST_CASE("FLIP: the plain implementation says the same, pixel by pixel")
{
    CpuImage edges(34, 26, glm::vec4(0.1f));
    for (std::uint32_t y = 0; y < edges.height; ++y)
        for (std::uint32_t x = 0; x < edges.width; ++x)
            if (x > 15 || (y == 7 && x % 5 == 0))
                edges.at(x, y) = glm::vec4(0.7f, 0.4f, 0.2f, 1.0f);
    CpuImage dark = edges;
    for (glm::vec4& p : dark.pixels)
        p *= 0.8f;
    const CpuImage noise = makeNoise(34, 26, 3), other = makeNoise(34, 26, 4);
    const std::pair<const CpuImage*, const CpuImage*> pairs[] = {
        {&noise, &other}, {&edges, &dark}, {&edges, &noise}};
    for (const auto& [a, b] : pairs)
        for (const double pixelsPerDegree : {kFlipPixelsPerDegree, 30.0}) {
            const CpuImage ours = computeFlip(*a, *b, pixelsPerDegree);
            const std::vector<double> plain = plainFlip(*a, *b, pixelsPerDegree);
            double worst = 0.0;
            for (std::size_t i = 0; i < plain.size(); ++i)
                worst = std::max(worst, std::abs(double(ours.pixels[i].x) - plain[i]));
            // The paper's program rounds the primaries differently in the fourth digit.
            CHECK(worst < 2e-3);
            CHECK(meanOf(ours) > 0.02);
        }
}

TEST_CASE("FLIP: pairs of solid colours, by the paper's formulas")
{
    const glm::vec3 colours[] = {{0, 0, 0}, {1, 1, 1}, {1, 0, 0},          {0, 1, 0},
                                 {0, 0, 1}, {1, 1, 0}, {0.2f, 0.5f, 0.7f}, {0.01f, 0.02f, 0.01f}};
    for (const glm::vec3& a : colours)
        for (const glm::vec3& b : colours) {
            const double value = flipOf(makeSolid(a, 2, 2), makeSolid(b, 2, 2));
            CHECK(value == doctest::Approx(plainFlipOfColours(a, b)).epsilon(2e-3).scale(0.05));
            CHECK(value >= 0.0);
            CHECK(value <= 1.0);
            CHECK((value == 0.0) == (a == b));
        }
}

TEST_CASE("FLIP: contrast sensitivity: fine gratings fade, coloured ones before grey ones")
{
    // Cycles per degree: 2, 10, 30 of the same contrast.
    const glm::dvec3 grey(0.15);
    CHECK(seen(4.0, grey) > 1.2 * seen(20.0, grey));
    CHECK(seen(20.0, grey) > 2.0 * seen(60.0, grey));
    // Blue against yellow at constant luminance is gone at 10 cycles per degree, grey is not.
    const glm::dvec3 blue(-0.0151, -0.0151, 0.1947);
    CHECK(seen(2.0, blue) > 0.05);
    CHECK(seen(20.0, blue) / seen(2.0, blue) < 0.5 * seen(20.0, grey) / seen(2.0, grey));
}

TEST_CASE("FLIP: the further the observer, the less is seen")
{
    const CpuImage a = makeNoise(64, 48, 5), b = makeNoise(64, 48, 6);
    double last = 2.0;
    for (const double pixelsPerDegree : {15.0, 30.0, 67.0, 130.0, 260.0}) {
        const double value = meanOf(computeFlip(a, b, pixelsPerDegree));
        CHECK(value < last);
        last = value;
    }
    // A flat difference is the same from everywhere.
    CHECK(meanOf(computeFlip(makeSolid(glm::vec3(0.3f)), makeSolid(glm::vec3(0.4f)), 20.0)) ==
          doctest::Approx(
              meanOf(computeFlip(makeSolid(glm::vec3(0.3f)), makeSolid(glm::vec3(0.4f)), 120.0))));
}

TEST_CASE("FLIP: solid pictures give the formula's value")
{
    // By hand: |dL|^0.7 = 100^0.7 = 25.119; the largest difference (Hunt-adjusted green to blue)
    // 203.3^0.7 = 41.27; 0.95 + 0.05 (25.119 - 16.51) / (41.27 - 16.51) = 0.9674.
    CHECK(flipOf(makeSolid(glm::vec3(0.0f)), makeSolid(glm::vec3(1.0f))) ==
          doctest::Approx(0.9674).epsilon(2e-4));
    CHECK(flipOf(makeSolid({0.0f, 1.0f, 0.0f}), makeSolid({0.0f, 0.0f, 1.0f})) ==
          doctest::Approx(1.0).epsilon(1e-5));
    // Greys: L* of 0.25 and 0.5 are 57.08 and 76.07; 18.99^0.7 = 7.853, times 0.95 / 16.51.
    CHECK(flipOf(makeSolid(glm::vec3(0.25f)), makeSolid(glm::vec3(0.5f))) ==
          doctest::Approx(0.4519).epsilon(2e-3));
}

TEST_CASE("FLIP: identity, symmetry, bounds, clamping and observer")
{
    const CpuImage a = makeNoise(64, 48, 5);
    const CpuImage b = makeNoise(64, 48, 6);
    CHECK(flipOf(a, a) == 0.0);
    CHECK(flipOf(a, b) == doctest::Approx(flipOf(b, a)).epsilon(1e-6));
    for (const glm::vec4& p : computeFlip(a, b).pixels) {
        CHECK(p.x >= 0.0f);
        CHECK(p.x <= 1.0f);
    }
    CHECK(flipOf(makeSolid(glm::vec3(9.0f)), makeSolid(glm::vec3(1.0f))) == 0.0);
    // From further away (more pixels per degree) noise is averaged by the eye.
    CHECK(meanOf(computeFlip(a, b, 200.0)) < meanOf(computeFlip(a, b, 20.0)));
}

TEST_CASE("FLIP: an edge that only one picture has weighs more than its colour alone")
{
    CpuImage flat = makeSolid(glm::vec3(0.2f), 65, 65);
    CpuImage line = flat;
    for (std::uint32_t y = 0; y < 65; ++y)
        line.at(32, y) = glm::vec4(0.4f, 0.4f, 0.4f, 1.0f);
    const CpuImage error = computeFlip(line, flat);
    CHECK(error.at(32, 32).x > 0.2f);
    CHECK(error.at(5, 32).x < 0.01f);
    for (std::uint32_t x = 0; x < 65; ++x)
        CHECK(error.at(x, 32).x == doctest::Approx(error.at(64 - x, 32).x).epsilon(1e-4));
}
