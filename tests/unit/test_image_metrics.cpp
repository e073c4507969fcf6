// Image metrics against closed forms and hand-computed values.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "engine/base/cie_lab.hpp"
#include "engine/base/error.hpp"
#include "engine/base/flip.hpp"
#include "engine/base/image_io.hpp"
#include "engine/base/image_metrics.hpp"
#include "shaders/shared/rng.h"

using namespace strandlight;

namespace {

CpuImage makeSolid(glm::vec3 colour, std::uint32_t width = 40, std::uint32_t height = 30)
{
    return CpuImage(width, height, glm::vec4(colour, 1.0f));
}

CpuImage makeNoise(std::uint32_t width, std::uint32_t height, std::uint32_t seed)
{
    CpuImage image(width, height);
    for (std::uint32_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = glm::vec4(gpu::uniform3(i, 0, 0, seed), 1.0f);
    return image;
}

double meanOf(const CpuImage& image)
{
    double sum = 0.0;
    for (const glm::vec4& p : image.pixels)
        sum += p.x;
    return sum / static_cast<double>(image.pixels.size());
}

double flipOf(const CpuImage& a, const CpuImage& b)
{
    return meanOf(computeFlip(a, b));
}

} // namespace

TEST_CASE("metrics: equal pictures")
{
    const CpuImage image = makeNoise(50, 31, 1);
    const ImageComparison c = compareImages(image, image);
    CHECK(c.rmse == 0.0);
    CHECK(c.relMse == 0.0);
    CHECK(c.blockRmse == 0.0);
    CHECK(std::isinf(c.psnr));
    CHECK(c.ssim == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(c.flip == 0.0);
    CHECK(c.mean == c.referenceMean);
    CHECK(c.nonFinite == 0);
}

TEST_CASE("metrics: closed forms for solid pictures")
{
    const ImageComparison c =
        compareImages(makeSolid({0.5f, 2.0f, 0.25f}), makeSolid({0.25f, 1.0f, 0.25f}));
    CHECK(c.rmse == doctest::Approx(std::sqrt((0.0625 + 1.0) / 3.0)));
    CHECK(c.relMse == doctest::Approx((0.0625 / 0.0725 + 1.0 / 1.01) / 3.0));
    CHECK(c.blockRmse == doctest::Approx(c.rmse));
    CHECK(c.mean.y == doctest::Approx(2.0));
    CHECK(c.referenceMean.x == doctest::Approx(0.25));
    // Green is clamped to 1 in both; red is 0.7354 and 0.5371 in sRGB coding.
    const double d = encodeSrgb(0.5f) - encodeSrgb(0.25f);
    CHECK(c.psnr == doctest::Approx(-10.0 * std::log10(d * d / 3.0)));
}

TEST_CASE("metrics: exposure acts before the clamp, in stops")
{
    const CpuImage a = makeNoise(30, 30, 2);
    CpuImage b = a;
    for (glm::vec4& p : b.pixels)
        p = p * 4.0f;
    const CompareSettings down{.exposureStops = -20.0f};
    CHECK(compareImages(a, b, down).flip < 0.01);
    CHECK(compareImages(a, b).flip > 0.1);
    CHECK(displayImage(makeSolid(glm::vec3(0.1f)), 2.0f).at(3, 3).x == doctest::Approx(0.4f));
}

TEST_CASE("metrics: block means average noise away, also in cut blocks")
{
    // A checkerboard of +1 and -1 has block means of zero where the block's pixel count is even.
    CpuImage a(20, 12, glm::vec4(5.0f));
    const CpuImage b(20, 12, glm::vec4(5.0f));
    for (std::uint32_t y = 0; y < 12; ++y)
        for (std::uint32_t x = 0; x < 20; ++x)
            a.at(x, y) += glm::vec4((x + y) % 2 ? 1.0f : -1.0f);
    const ImageComparison c = compareImages(a, b);
    CHECK(c.rmse == doctest::Approx(1.0));
    CHECK(c.blockRmse == doctest::Approx(0.0).scale(1.0));
    CHECK(compareImages(a, b, {.blockSide = 1}).blockRmse == doctest::Approx(1.0));
}

TEST_CASE("SSIM: closed forms of a constant shift and of a contrast change")
{
    // Solid pictures: (2 ab + C1) / (a^2 + b^2 + C1), the structure term being C2 / C2.
    CpuImage a(24, 24, glm::vec4(0.6f));
    CpuImage b(24, 24, glm::vec4(0.3f));
    const double luminance = (2.0 * 0.6 * 0.3 + 1e-4) / (0.36 + 0.09 + 1e-4);
    CHECK(computeSsim(a, b) == doctest::Approx(luminance).epsilon(1e-6));

    // A picture of one window: moments by hand with the same Gaussian.
    CpuImage x = makeNoise(11, 11, 3);
    CpuImage y = x;
    for (glm::vec4& p : y.pixels)
        p.x = 0.5f * p.x + 0.1f;
    double sum = 0.0;
    double mean = 0.0;
    double square = 0.0;
    for (int j = 0; j < 11; ++j)
        for (int i = 0; i < 11; ++i) {
            const double w = std::exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / 4.5);
            const double v = x.pixels[static_cast<std::size_t>(j * 11 + i)].x;
            sum += w;
            mean += w * v;
            square += w * v * v;
        }
    mean /= sum;
    const double variance = square / sum - mean * mean;
    const double other = 0.5 * mean + 0.1;
    const double expected = (2.0 * mean * other + 1e-4) * (variance + 9e-4) /
                            ((mean * mean + other * other + 1e-4) * (1.25 * variance + 9e-4));
    CHECK(computeSsim(x, y) == doctest::Approx(expected).epsilon(1e-5));
    CHECK(computeSsim(x, y) == doctest::Approx(computeSsim(y, x)).epsilon(1e-12));
}

TEST_CASE("SSIM: an inverted pattern scores below zero, tiny pictures have a value")
{
    CpuImage a = makeNoise(32, 32, 4);
    CpuImage b = a;
    for (glm::vec4& p : b.pixels)
        p.x = 1.0f - p.x;
    CHECK(computeSsim(a, b) < -0.5);
    CHECK(computeSsim(CpuImage(3, 2, glm::vec4(0.2f)), CpuImage(3, 2, glm::vec4(0.2f))) ==
          doctest::Approx(1.0));
}

TEST_CASE("CIELAB: known colours and the way back")
{
    const auto check = [](glm::dvec3 rgb, glm::dvec3 lab) {
        CHECK(glm::distance(labFromRgb(rgb), lab) < 0.05);
        CHECK(glm::distance(rgbFromLab(labFromRgb(rgb)), rgb) < 1e-9);
    };
    check({1.0, 1.0, 1.0}, {100.0, 0.0, 0.0});
    check({1.0, 0.0, 0.0}, {53.24, 80.09, 67.20});
    check({0.0, 1.0, 0.0}, {87.73, -86.18, 83.18});
    check({0.0, 0.0, 1.0}, {32.30, 79.19, -107.86});
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

TEST_CASE("metrics: non-finite pixels are counted, left out, and shown as black")
{
    CpuImage a = makeSolid(glm::vec3(0.5f));
    const CpuImage b = a;
    a.at(3, 3).y = std::numeric_limits<float>::quiet_NaN();
    a.at(4, 4).x = std::numeric_limits<float>::infinity();
    const ImageComparison c = compareImages(a, b);
    CHECK(c.nonFinite == 2);
    CHECK(c.referenceNonFinite == 0);
    CHECK(c.rmse == 0.0);
    CHECK(c.mean.x == doctest::Approx(0.5));
    CHECK(c.flip > 0.0);
    CHECK(c.ssim < 1.0);
    CHECK(std::isfinite(c.psnr));
}

TEST_CASE("metrics: different sizes are refused with both in the text")
{
    try {
        compareImages(makeSolid(glm::vec3(0.0f), 4, 5), makeSolid(glm::vec3(0.0f), 6, 7));
        FAIL("no error");
    } catch (const Error& error) {
        CHECK(std::string(error.what()).find("4 x 5 and 6 x 7") != std::string::npos);
    }
    CHECK_THROWS_AS(computeFlip(CpuImage(), CpuImage()), Error);
    CHECK_THROWS_AS(computeSsim(CpuImage(1, 1), CpuImage(2, 1)), Error);
}

TEST_CASE("heat map: lightness follows the error, ends are nearly black and nearly white")
{
    CpuImage error(256, 1);
    for (std::uint32_t i = 0; i < 256; ++i)
        error.at(i, 0) = glm::vec4(static_cast<float>(i) / 255.0f);
    const CpuImage map = heatmap(error);
    double last = -1.0;
    for (std::uint32_t i = 0; i < 256; ++i) {
        const double lightness = labFromRgb(glm::dvec3(map.at(i, 0))).x;
        CHECK(lightness > last);
        // Colours that sRGB lacks are clamped, which moves lightness a little.
        CHECK(lightness == doctest::Approx(2.0 + 95.0 * i / 255.0).epsilon(0.04).scale(100.0));
        last = lightness;
    }
}
