// Image metrics against closed forms and hand-computed values; SSIM and FLIP have files of their
// own.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "engine/base/cie_lab.hpp"
#include "engine/base/error.hpp"
#include "engine/base/flip.hpp"
#include "engine/base/image_io.hpp"
#include "engine/base/image_metrics.hpp"
#include "tests/unit/metric_pictures.hpp"

using namespace strandlight;
using namespace strandlight::test;

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

TEST_CASE("metrics: relMSE divides by the reference, so it has a direction")
{
    const CpuImage dark = makeSolid(glm::vec3(0.1f)), bright = makeSolid(glm::vec3(1.0f));
    CHECK(compareImages(bright, dark).relMse == doctest::Approx(0.81 / 0.02));
    CHECK(compareImages(dark, bright).relMse == doctest::Approx(0.81 / 1.01));
    CHECK(compareImages(dark, bright).rmse == compareImages(bright, dark).rmse);
}

TEST_CASE("metrics: a difference of one tenth of the coded range is 20 dB, of all of it 0 dB")
{
    // IEC 61966-2-1, the linear value of a coded one.
    const auto linear = [](double coded) {
        return glm::vec3(static_cast<float>(std::pow((coded + 0.055) / 1.055, 2.4)));
    };
    const auto psnr = [](const CpuImage& a, const CpuImage& b) { return compareImages(a, b).psnr; };
    CHECK(psnr(makeSolid(linear(0.6)), makeSolid(linear(0.5))) ==
          doctest::Approx(20.0).epsilon(1e-5));
    CHECK(psnr(makeSolid(linear(0.51)), makeSolid(linear(0.5))) ==
          doctest::Approx(40.0).epsilon(1e-4));
    CHECK(psnr(makeSolid(glm::vec3(0.0f)), makeSolid(glm::vec3(1.0f))) ==
          doctest::Approx(0.0).scale(1.0));
}

TEST_CASE("metrics: relMSE of a factor does not depend on brightness, and is not symmetric")
{
    const auto relative = [](float a, float b) {
        return compareImages(makeSolid(glm::vec3(a)), makeSolid(glm::vec3(b))).relMse;
    };
    // (1.1 b - b)^2 / (b^2 + 0.01)
    CHECK(relative(110.0f, 100.0f) == doctest::Approx(0.01).epsilon(1e-4));
    CHECK(relative(1.1f, 1.0f) == doctest::Approx(0.01 / 1.01).epsilon(1e-5));
    CHECK(relative(2.0f, 1.0f) > 3.0 * relative(1.0f, 2.0f));
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
