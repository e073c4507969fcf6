// Sample masks: the right number of bits on average, every mask as often as it should be, and no
// dependence between layers, neighbours and frames.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>

#include <doctest/doctest.h>

#include "shaders/shared/hair_masks.h"

using namespace strandlight;

namespace {

constexpr std::uint32_t kSide = 256;

std::uint32_t maskAt(float alpha, std::uint32_t strand, std::uint32_t x, std::uint32_t y,
                     std::uint32_t frame = 0)
{
    return gpu::hairSampleMask(alpha,
                               gpu::hairFragmentBits(strand, strand * 15u + 3u, x, y, frame));
}

} // namespace

TEST_CASE("hair masks: mean coverage is alpha")
{
    for (const float alpha : {0.0f, 0.05f, 0.1f, 0.25f, 0.5f, 0.75f, 1.0f}) {
        double bits = 0.0;
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x)
                bits += std::popcount(maskAt(alpha, 7, x, y));
        const double pixels = double(kSide) * kSide;
        // k is floor(4 alpha) or one more: its variance is f (1 - f) for the fraction f of 4 alpha.
        const double part = 4.0 * alpha - std::floor(4.0 * alpha);
        const double error = std::sqrt(part * (1.0 - part) / pixels) / 4.0;
        CAPTURE(alpha);
        CHECK(std::abs(bits / (4.0 * pixels) - alpha) <= 4.0 * error + 1e-7);
    }
}

TEST_CASE("hair masks: all masks of k samples are equally likely")
{
    for (const float alpha : {0.25f, 0.5f, 0.75f}) {
        std::array<double, 16> counts{};
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x)
                counts[maskAt(alpha, 11, x, y)] += 1.0;
        const int k = int(4.0f * alpha);
        const int masks = k == 2 ? 6 : 4;
        const double expected = double(kSide) * kSide / masks;
        double chiSquare = 0.0;
        for (std::uint32_t mask = 0; mask < 16; ++mask) {
            if (std::popcount(mask) == k)
                chiSquare += (counts[mask] - expected) * (counts[mask] - expected) / expected;
            else
                CHECK(counts[mask] == 0.0);
        }
        CAPTURE(alpha);
        // 99.9 % quantiles of chi-square with 5 and 3 degrees of freedom.
        CHECK(chiSquare <= (k == 2 ? 20.52 : 16.27));
    }
}

TEST_CASE("hair masks: layers, neighbours and frames are independent")
{
    // Share of samples that two masks of alpha 1/2 both cover: 1/4 when they are independent; a
    // hash of the pixel alone would give 1/2 for layers.
    double layers = 0.0, neighbours = 0.0, frames = 0.0;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const std::uint32_t mask = maskAt(0.5f, 3, x, y);
            layers += std::popcount(mask & maskAt(0.5f, 4, x, y));
            neighbours += std::popcount(mask & maskAt(0.5f, 3, x + 1, y));
            frames += std::popcount(mask & maskAt(0.5f, 3, x, y, 1));
        }
    const double pixels = double(kSide) * kSide;
    // Two of four against two of four: hypergeometric, variance of the count 1/3.
    const double tolerance = 4.0 * std::sqrt(1.0 / 3.0 / pixels) / 4.0;
    CHECK(std::abs(layers / (4.0 * pixels) - 0.25) <= tolerance);
    CHECK(std::abs(neighbours / (4.0 * pixels) - 0.25) <= tolerance);
    CHECK(std::abs(frames / (4.0 * pixels) - 0.25) <= tolerance);
}

TEST_CASE("hair masks: alpha out of range")
{
    const glm::uvec3 bits(0xFFFFFFFFu, 0xFFFFFFFFu, 0u);
    CHECK(gpu::hairSampleMask(-1.0f, bits) == 0u);
    CHECK(gpu::hairSampleMask(std::numeric_limits<float>::quiet_NaN(), bits) == 0u);
    CHECK(gpu::hairSampleMask(2.0f, bits) == 15u);
    CHECK(gpu::hairSampleMask(1.0f, glm::uvec3(0u)) == 15u);
    CHECK(std::popcount(gpu::hairSampleMask(0.5f, bits)) == 2);
}
