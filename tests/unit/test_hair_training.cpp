// What the filter network's training draws: looks that keep the held-out ones out, and crops that a
// mirrored scene would have given.
#include <algorithm>
#include <cmath>
#include <functional>

#include <doctest/doctest.h>
#include <glm/gtc/packing.hpp>

#include "passes/hair_train.hpp"
#include "passes/hair_training_batch.hpp"

using namespace strandlight;

namespace {

constexpr std::uint32_t kSide = 16;

// A picture as a function of place (pixels, y down) and of which symmetry the world underwent.
struct World
{
    HairAugmentation turn; // of the world, samples and exposure left alone

    // Where a point of the turned picture lay before.
    glm::dvec2 before(glm::dvec2 p) const
    {
        p = {turn.flipX ? double(kSide) - p.x : p.x, turn.flipY ? double(kSide) - p.y : p.y};
        return turn.transpose ? glm::dvec2(p.y, p.x) : p;
    }
    glm::dvec2 turned(glm::dvec2 direction) const
    {
        const glm::dvec2 d = turn.transpose ? glm::dvec2(direction.y, direction.x) : direction;
        return {turn.flipX ? -d.x : d.x, turn.flipY ? -d.y : d.y};
    }
    // Value of plane kind 0 to 5 at a place of the turned picture.
    double value(std::uint32_t kind, std::uint32_t sample, glm::dvec2 p) const
    {
        const glm::dvec2 q = before(p);
        const double scalar = 0.3 + 0.02 * q.x + 0.011 * q.y + 0.05 * double(sample + 4 * kind);
        if (kind < 4)
            return scalar;
        const glm::dvec2 d = turned({std::cos(scalar), std::sin(scalar)});
        const double angle = std::atan2(d.y, d.x);
        return kind == 4 ? std::cos(2.0 * angle) : std::sin(2.0 * angle);
    }
};

HairTrainingFrame frameOf(const World& world)
{
    HairTrainingFrame frame{kSide, 2, false, {}};
    frame.planes.resize(frame.planeCount() * kSide * kSide);
    for (std::size_t plane = 0; plane < frame.planeCount(); ++plane)
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x) {
                const glm::dvec2 p(double(x) + 0.5, double(y) + 0.5);
                const bool isInput = plane < 24;
                const double v = isInput ? world.value(std::uint32_t(plane / 4), plane % 4, p)
                                         : world.value(0, std::uint32_t(plane % 7), p);
                frame.planes[(plane * kSide + y) * kSide + x] = glm::packHalf1x16(float(v));
            }
    return frame;
}

double largestDifference(const std::vector<float>& a, const std::vector<float>& b)
{
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, std::abs(double(a[i]) - double(b[i])));
    return largest;
}

} // namespace

TEST_CASE("hair training: a turned crop is the crop of the turned scene")
{
    const HairTrainingFrame frame = frameOf({});
    for (int symmetry = 0; symmetry < 8; ++symmetry) {
        CAPTURE(symmetry);
        HairAugmentation how;
        how.transpose = (symmetry & 1) != 0;
        how.flipX = (symmetry & 2) != 0;
        how.flipY = (symmetry & 4) != 0;
        HairBatch turned = makeHairBatch(1, kSide), expected = makeHairBatch(1, kSide);
        fillHairCrop(turned, 0, frame, 0, glm::uvec2(0), how);
        fillHairCrop(expected, 0, frameOf({how}), 0, glm::uvec2(0), {});
        // Half floats of both sides round apart: 2^-11 of values up to 2.
        CHECK(largestDifference(turned.input, expected.input) < 2e-3);
        CHECK(largestDifference(turned.target, expected.target) < 4e-3);
        CHECK(largestDifference(turned.image, expected.image) < 2e-3);
        CHECK(largestDifference(turned.truth, expected.truth) < 2e-3);
        if (symmetry != 0) // the test would see a turn that is forgotten
            CHECK(largestDifference(turned.input, [&] {
                      HairBatch same = makeHairBatch(1, kSide);
                      fillHairCrop(same, 0, frame, 0, glm::uvec2(0), {});
                      return same.input;
                  }()) > 0.05);
    }
}

TEST_CASE("hair training: exposure scales radiance, samples change places")
{
    const HairTrainingFrame frame = frameOf({});
    HairBatch plain = makeHairBatch(1, kSide), changed = makeHairBatch(1, kSide);
    fillHairCrop(plain, 0, frame, 1, glm::uvec2(0), {});
    HairAugmentation how;
    how.exposure = 2.0f;
    how.samples = {2, 0, 3, 1};
    fillHairCrop(changed, 0, frame, 1, glm::uvec2(0), how);
    constexpr std::size_t kPixels = kSide * kSide;
    for (std::size_t i = 0; i < kPixels; i += 7) {
        for (std::size_t s = 0; s < 4; ++s) {
            const std::size_t from = how.samples[s] * kPixels + i;
            const double brightness = std::expm1(double(plain.input[from]));
            CHECK(changed.input[s * kPixels + i] ==
                  doctest::Approx(std::log1p(2.0 * brightness)).epsilon(1e-5));
            for (std::size_t kind = 1; kind < 6; ++kind)
                REQUIRE(changed.input[(4 * kind + s) * kPixels + i] ==
                        plain.input[4 * kind * kPixels + from]);
        }
        const auto brightness = [&](const HairBatch& batch) { // the target is above the blended one
            return std::expm1(double(batch.input[gpu::kHairInputBlended * kPixels + i]) +
                              double(batch.target[i]));
        };
        CHECK(brightness(changed) == doctest::Approx(2.0 * brightness(plain)).epsilon(1e-5));
        const std::size_t blended = gpu::kHairInputBlended * kPixels + i;
        CHECK(std::expm1(double(changed.input[blended])) ==
              doctest::Approx(2.0 * std::expm1(double(plain.input[blended]))).epsilon(1e-5));
        CHECK(changed.target[kPixels + i] == plain.target[kPixels + i]);
        CHECK(changed.target[2 * kPixels + i] == plain.target[2 * kPixels + i]);
        CHECK(changed.image[i] == 2.0f * plain.image[i]);
        CHECK(changed.truth[i] == 2.0f * plain.truth[i]);
    }
}

TEST_CASE("hair training: the held-out style and grooms are never trained on")
{
    std::vector<std::uint32_t> seeds;
    for (std::uint32_t i = 0; i < 200; ++i) {
        const HairTrainingLook look = hairTrainingLook(1, i, false);
        CHECK(look.style != kHeldOutStyle);
        seeds.push_back(look.groom.seed);
        const HairTrainingLook again = hairTrainingLook(1, i, false);
        CHECK(again.groom.seed == look.groom.seed);
        CHECK(again.viewDirection == look.viewDirection);
    }
    int heldOutStyle = 0;
    for (std::uint32_t i = 0; i < 12; ++i) {
        const HairTrainingLook look = hairTrainingLook(1, i, true);
        heldOutStyle += look.style == kHeldOutStyle ? 1 : 0;
        CHECK(std::find(seeds.begin(), seeds.end(), look.groom.seed) == seeds.end());
    }
    CHECK(heldOutStyle == 4);
    CHECK(hairTrainingLook(2, 0, false).groom.seed != hairTrainingLook(1, 0, false).groom.seed);
}

TEST_CASE("hair training: a step's crops depend on seed and step alone")
{
    const std::vector<HairTrainingFrame> frames = {frameOf({})};
    const HairBatch a = drawHairBatch(frames, 3, 8, 5, 11), b = drawHairBatch(frames, 3, 8, 5, 11);
    CHECK(a.input == b.input);
    CHECK(a.target == b.target);
    CHECK(drawHairBatch(frames, 3, 8, 5, 12).input != a.input);
    CHECK(drawHairBatch(frames, 3, 8, 6, 11).input != a.input);
}

TEST_CASE("hair training: the learning rate falls from its start to a hundredth")
{
    HairTrainSettings settings;
    settings.steps = 100;
    CHECK(hairLearningRate(settings, 0) == doctest::Approx(settings.learningRate));
    CHECK(hairLearningRate(settings, 100) == doctest::Approx(0.01 * settings.learningRate));
    for (std::uint32_t step = 0; step < 100; ++step)
        CHECK(hairLearningRate(settings, step + 1) < hairLearningRate(settings, step));
}
