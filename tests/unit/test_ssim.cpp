// SSIM against closed forms and against a plain implementation in double that shares nothing with
// ours. Wang, Bovik, Sheikh, Simoncelli. Image Quality Assessment: From Error Visibility to
// Structural Similarity. 2004
#include <cmath>

#include <doctest/doctest.h>

#include "engine/base/image_metrics.hpp"
#include "tests/unit/metric_pictures.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

// The paper's equation 13 window by window: weights of the whole 11 x 11 window at once, centred
// moments.
double plainSsim(const CpuImage& a, const CpuImage& b)
{
    double sum = 0.0;
    int windows = 0;
    for (int y = 5; y + 5 < int(a.height); ++y)
        for (int x = 5; x + 5 < int(a.width); ++x, ++windows) {
            const auto average = [&](auto value) {
                double total = 0.0, weights = 0.0;
                for (int j = -5; j <= 5; ++j)
                    for (int i = -5; i <= 5; ++i) {
                        const double w = std::exp(-(i * i + j * j) / (2.0 * 1.5 * 1.5));
                        const auto px = std::uint32_t(x + i), py = std::uint32_t(y + j);
                        total += w * value(double(a.at(px, py).x), double(b.at(px, py).x));
                        weights += w;
                    }
                return total / weights;
            };
            const double ma = average([](double p, double) { return p; });
            const double mb = average([](double, double q) { return q; });
            const double va = average([&](double p, double) { return (p - ma) * (p - ma); });
            const double vb = average([&](double, double q) { return (q - mb) * (q - mb); });
            const double ab = average([&](double p, double q) { return (p - ma) * (q - mb); });
            const double luminance = (2.0 * ma * mb + 1e-4) / (ma * ma + mb * mb + 1e-4);
            const double structure = (2.0 * ab + 9e-4) / (va + vb + 9e-4);
            sum += luminance * structure;
        }
    return sum / windows;
}

} // namespace

TEST_CASE("SSIM: the plain implementation says the same of unrelated, shifted, inverted and "
          "blurred pictures")
{
    const CpuImage a = makeNoise(27, 19, 8);
    CpuImage shifted = a, inverted = a, blurred = a, brighter = a;
    for (std::uint32_t y = 0; y < a.height; ++y)
        for (std::uint32_t x = 0; x < a.width; ++x) {
            shifted.at(x, y) = a.at((x + 1) % a.width, y);
            inverted.at(x, y).x = 1.0f - a.at(x, y).x;
            blurred.at(x, y).x = (a.at(x, y).x + a.at((x + 1) % a.width, y).x) * 0.5f;
            brighter.at(x, y).x = 0.9f * a.at(x, y).x + 0.1f;
        }
    const CpuImage noise = makeNoise(27, 19, 9);
    const CpuImage* others[] = {&noise, &shifted, &inverted, &blurred, &brighter};
    for (const CpuImage* other : others) {
        CHECK(computeSsim(a, *other) == doctest::Approx(plainSsim(a, *other)).epsilon(1e-9));
        CHECK(computeSsim(a, *other) == doctest::Approx(computeSsim(*other, a)).epsilon(1e-12));
        CHECK(std::abs(computeSsim(a, *other)) < 1.0);
    }
    // What the measure is for: a change of brightness counts less than lost structure.
    CHECK(computeSsim(a, brighter) > computeSsim(a, blurred));
    CHECK(computeSsim(a, blurred) > computeSsim(a, noise));
}

TEST_CASE("SSIM: solid pictures have the luminance term alone")
{
    const auto of = [](float a, float b) {
        return computeSsim(CpuImage(20, 20, glm::vec4(a)), CpuImage(20, 20, glm::vec4(b)));
    };
    CHECK(of(0.0f, 1.0f) == doctest::Approx(1e-4 / 1.0001).epsilon(1e-6));
    CHECK(of(0.5f, 0.5f) == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(of(0.2f, 0.8f) ==
          doctest::Approx((2.0 * 0.16 + 1e-4) / (0.04 + 0.64 + 1e-4)).epsilon(1e-6));
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
