// How much hair covers: transmittance of stacked layers, expected coverage of thin strands, the
// exact product, and that noise, truth and level of detail agree.
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include <doctest/doctest.h>

#include "passes/hair_render.hpp"
#include "shaders/shared/rng.h"
#include "tests/gpu/hair_cases.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

double meanTransmittance(const CpuImage& hair)
{
    double sum = 0.0;
    for (const glm::vec4& pixel : hair.pixels)
        sum += double(pixel.w);
    return sum / double(hair.pixels.size());
}

// Covered area of each cell over that of its strands' rectangles.
std::vector<double> relativeCoverage(const CpuImage& picture, bool transmittanceInX, float width)
{
    std::vector<double> covered(kCells * kCells, 0.0);
    for (std::uint32_t y = 0; y < kGridSide; ++y)
        for (std::uint32_t x = 0; x < kGridSide; ++x) {
            const std::uint32_t cell = (kCells - 1 - y / kCell) * kCells + x / kCell; // y up
            const glm::vec4& pixel = picture.at(x, y);
            covered[cell] += 1.0 - double(transmittanceInX ? pixel.x : pixel.w);
        }
    for (double& value : covered)
        value /= double(strandsPerCell(width)) * double(kStrandLength) * double(width);
    return covered;
}

} // namespace

TEST_CASE("hair: mean transmittance of a layer and of stacked layers")
{
    constexpr std::uint32_t kSide = 96;
    const double samples = 4.0 * kSide * kSide;
    const auto check = [&](float alpha, std::uint32_t count) {
        HairRenderSettings settings = plainSettings(kSide);
        settings.alpha = alpha;
        const HairFrame frame = renderHair(test::context(), layers(count, float(kSide)), nullptr,
                                           pixelCamera(kSide), settings);
        const double expected = std::pow(1.0 - double(alpha), double(count));
        // Samples as if independent: k-of-4 masks only lower the variance. RGBA16F holds 0 and 1
        // exactly.
        const double error = std::sqrt(expected * (1.0 - expected) / samples);
        CAPTURE(alpha);
        CAPTURE(count);
        CHECK(std::abs(meanTransmittance(frame.hair) - expected) <= 4.0 * error + 1e-6);
    };
    for (const float alpha : {0.0f, 0.05f, 0.1f, 0.25f, 0.5f, 0.75f, 1.0f})
        check(alpha, 1);
    for (const std::uint32_t count : {2u, 4u, 8u, 16u})
        for (const float alpha : {0.05f, 0.1f, 0.25f})
            check(alpha, count);
}

TEST_CASE("hair: alpha to coverage gives stacked layers the same samples")
{
    constexpr std::uint32_t kSide = 32;
    HairRenderSettings settings = plainSettings(kSide);
    settings.filter = HairFilter::AlphaToCoverage;
    const auto transmittance = [&](float alpha, std::uint32_t count) {
        settings.alpha = alpha;
        return meanTransmittance(renderHair(test::context(), layers(count, float(kSide)), nullptr,
                                            pixelCamera(kSide), settings)
                                     .hair);
    };
    CHECK(transmittance(0.0f, 1) == 1.0);
    CHECK(transmittance(1.0f, 1) == 0.0);
    // How alpha becomes a mask is the device's business, but within one sample of it.
    CHECK(std::abs(transmittance(0.5f, 1) - 0.5) <= 0.25);
    // What random masks are for: four layers of 1/2 let 1/16 through.
    CHECK(transmittance(0.5f, 4) == transmittance(0.5f, 1));
}

TEST_CASE("hair: expected coverage of thin strands at 16 angles")
{
    struct Case
    {
        float width;
        std::uint32_t frames; // the thinner, the fewer samples it hits per frame
    };
    for (const Case c :
         {Case{0.02f, 240}, Case{0.1f, 40}, Case{0.5f, 8}, Case{1.0f, 4}, Case{3.0f, 4}}) {
        HairRenderSettings settings = plainSettings(kGridSide);
        settings.frames = c.frames;
        settings.exactCoverage = true;
        const HairFrame frame = renderHair(test::context(), strandGrid(c.width), nullptr,
                                           pixelCamera(kGridSide), settings);
        const std::vector<double> noisy = relativeCoverage(frame.hair, false, c.width);
        const std::vector<double> exact = relativeCoverage(frame.exactTransmittance, true, c.width);
        for (std::size_t angle = 0; angle < noisy.size(); ++angle) {
            CAPTURE(c.width);
            CAPTURE(angle);
            CHECK(std::abs(noisy[angle] - 1.0) <= 0.02);
            CHECK(std::abs(exact[angle] - 1.0) <= 0.02);
        }
    }
}

TEST_CASE("hair: true-width strands converge to the same coverage")
{
    constexpr float kWidth = 0.25f;
    HairRenderSettings settings = plainSettings(kGridSide);
    settings.mode = HairMode::Reference;
    settings.frames = 32;
    const HairFrame frame =
        renderHair(test::context(), strandGrid(kWidth), nullptr, pixelCamera(kGridSide), settings);
    // One angle's samples may fall between fine strands together: 3 % where the mean of all is 1 %.
    double mean = 0.0;
    for (const double value : relativeCoverage(frame.hair, false, kWidth)) {
        CHECK(std::abs(value - 1.0) <= 0.03);
        mean += value / 16.0;
    }
    CHECK(std::abs(mean - 1.0) <= 0.01);
}

TEST_CASE("hair: averaged stochastic frames and the reference are one picture")
{
    constexpr std::uint32_t kSide = 64;
    HairStrands hair; // a tangle in which every pixel has several strands of several colours
    for (std::uint32_t i = 0; i < 500; ++i) {
        const glm::vec3 a = gpu::uniform3(i, 0u, 0u, 9u) - 0.5f;
        const glm::vec3 b = gpu::uniform3(i, 1u, 0u, 9u) - 0.5f;
        addStrand(hair, {50.0f * a, 25.0f * (a + b), 50.0f * b}, 0.1f);
        for (std::size_t p = hair.colors.size() - 3; p < hair.colors.size(); ++p)
            hair.colors[p] = 0.2f + 0.6f * gpu::uniform3(i, 2u, 0u, 9u);
    }
    HairRenderSettings settings = plainSettings(kSide);
    settings.frames = 64;
    const auto render = [&](HairMode mode) {
        settings.mode = mode;
        return renderHair(test::context(), hair, nullptr, pixelCamera(kSide), settings);
    };
    const HairFrame noisy = render(HairMode::Stochastic);
    const HairFrame truth = render(HairMode::Reference);
    glm::dvec4 sums(0.0), truths(0.0);
    double squares = 0.0;
    for (std::size_t i = 0; i < truth.hair.pixels.size(); ++i) {
        sums += glm::dvec4(noisy.hair.pixels[i]);
        truths += glm::dvec4(truth.hair.pixels[i]);
        const double difference = double(noisy.hair.pixels[i].w - truth.hair.pixels[i].w);
        squares += difference * difference;
    }
    const double pixels = double(truth.hair.pixels.size());
    CHECK(truths.w / pixels < 0.7); // there is enough hair to compare
    // 16,384 samples a frame of which the pictures' means are made: 0.2 % each; strands that cross
    // within a pixel cover a little less together than their product says.
    CHECK(std::abs(sums.w - truths.w) / (pixels - truths.w) <= 0.01);
    for (int c = 0; c < 3; ++c)
        CHECK(std::abs(sums[c] / truths[c] - 1.0) <= 0.01);
    // Per pixel the noise of 256 samples, 0.03 at most, in each; a ribbon a pixel wide is blurrier.
    CHECK(std::sqrt(squares / pixels) <= 0.06);
}

TEST_CASE("hair: exact coverage multiplies layers")
{
    constexpr std::uint32_t kSide = 32;
    HairRenderSettings settings = plainSettings(kSide);
    settings.exactCoverage = true;
    settings.alpha = 0.25f;
    for (const std::uint32_t count : {1u, 4u, 16u}) {
        const HairFrame frame = renderHair(test::context(), layers(count, float(kSide)), nullptr,
                                           pixelCamera(kSide), settings);
        const double expected = std::pow(0.75, double(count));
        for (const glm::vec4& pixel : frame.exactTransmittance.pixels)
            // Every product rounds by up to 2^-24.
            REQUIRE(std::abs(double(pixel.x) - expected) <= expected * double(count) * 0x1p-23);
    }
}

TEST_CASE("hair: the exact coverage corrects the noisy one")
{
    constexpr std::uint32_t kSide = 48;
    HairRenderSettings settings = plainSettings(kSide);
    settings.alpha = 0.3f;
    settings.filter = HairFilter::Coverage;
    const HairFrame frame =
        renderHair(test::context(), layers(3, float(kSide)), nullptr, pixelCamera(kSide), settings);
    for (std::size_t i = 0; i < frame.hair.pixels.size(); ++i) {
        const float exact = frame.exactTransmittance.pixels[i].x;
        const bool touched = frame.hair.pixels[i].w < 1.0f; // by any of the four samples
        if (touched)
            REQUIRE(frame.hair.pixels[i].w == exact);
    }
}

TEST_CASE("hair: every second strand twice as wide covers as much")
{
    HairRenderSettings settings = plainSettings(kGridSide);
    settings.exactCoverage = true;
    settings.lod = 2;
    const HairFrame frame =
        renderHair(test::context(), strandGrid(0.2f), nullptr, pixelCamera(kGridSide), settings);
    CHECK(frame.drawnStrands == kCells * kCells * std::uint32_t(strandsPerCell(0.2f)) / 2);
    double mean = 0.0;
    for (const double value : relativeCoverage(frame.exactTransmittance, true, 0.2f))
        mean += value / 16.0;
    CHECK(std::abs(mean - 1.0) <= 0.02); // as for all strands
}
