// Training of the filter network: frames agree with the renderer, steps lower the loss, and a run
// that was cut short goes on to the same bytes.
#include <cmath>
#include <filesystem>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "engine/scene/hair_head.hpp"
#include "passes/hair_render.hpp"
#include "passes/hair_train.hpp"
#include "tests/support/gltf_maker.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

constexpr std::uint32_t kSide = 32;

HairTrainingSettings tiny()
{
    return {.size = kSide, .repeats = 2, .targetSamples = 64, .strandShare = 0.03f};
}

const HairTrainingFrame& tinyFrame(bool heldOut)
{
    static const HairTrainingFrame frames[] = {
        makeHairTrainingFrame(test::context(), hairTrainingLook(1, 0, false), tiny(), false),
        makeHairTrainingFrame(test::context(), hairTrainingLook(1, 0, true), tiny(), true)};
    return frames[heldOut ? 1 : 0];
}

HairPool tinyPool()
{
    return {{tinyFrame(false)}, {tinyFrame(true)}, {"held out"}, 7};
}

HairTrainSettings tenSteps()
{
    HairTrainSettings settings;
    settings.net = HairUNetSize::Small;
    settings.steps = 10;
    settings.batch = 2;
    settings.crop = 16;
    settings.validateEvery = 4;
    return settings;
}

} // namespace

TEST_CASE("hair training data: the same look gives the same finite planes")
{
    const HairTrainingFrame& frame = tinyFrame(false);
    const HairTrainingFrame again =
        makeHairTrainingFrame(test::context(), hairTrainingLook(1, 0, false), tiny(), false);
    CHECK(frame.planes == again.planes);
    REQUIRE(frame.planes.size() == frame.planeCount() * kSide * kSide);
    bool noisesDiffer = false, hasHair = false;
    for (std::size_t plane = 0; plane < frame.planeCount(); ++plane)
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x) {
                REQUIRE(std::isfinite(frame.at(plane, x, y)));
                if (plane < 24)
                    noisesDiffer = noisesDiffer || frame.at(plane, x, y) !=
                                                       frame.at(frame.repeatPlane(1) + plane, x, y);
                hasHair = hasHair || (plane == 0 && frame.at(0, x, y) > 0.0f);
            }
    CHECK(noisesDiffer);
    CHECK(hasHair);
}

TEST_CASE("hair training data: the target is what the reference renderer shows")
{
    const HairTrainingLook look = hairTrainingLook(1, 0, true);
    const HairTrainingFrame& frame = tinyFrame(true);
    GroomSettings groom = look.groom;
    groom.strands = std::uint32_t(float(groom.strands) * tiny().strandShare);
    groom.radiusMetres /= std::sqrt(tiny().strandShare);
    const HairStrands hair = makeGroom(look.style, groom);
    Scene opaque = look.head ? headScene() : Scene{};
    opaque.lights = look.lights;
    HairRenderSettings settings;
    settings.width = settings.height = kSide;
    settings.mode = HairMode::Reference;
    settings.frames = 64;
    settings.roughness = look.roughness;
    settings.ambient = look.ambient;
    const CpuImage truth =
        renderHair(test::context(), hair, &opaque, hairTrainingCamera(look, hair), settings).hair;
    glm::dvec4 sum(0.0), square(0.0), mean(0.0);
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x)
            for (int c = 0; c < 4; ++c) {
                const double target = double(frame.at(frame.targetPlane() + std::size_t(c), x, y));
                const double difference = target - double(truth.at(x, y)[c]);
                sum[c] += difference;
                square[c] += difference * difference;
                mean[c] += target;
            }
    constexpr double kPixels = kSide * kSide;
    for (int c = 0; c < 4; ++c) {
        CAPTURE(c);
        // Other shadow noise and masks: of the means within 3 %. Pixels of 64 and 256 samples, with
        // a deviation of at most the mean's own size in one sample, differ by less than 0.2 of it.
        CHECK(std::abs(sum[c]) < 0.03 * mean[c]);
        CHECK(std::sqrt(square[c] / kPixels) < 0.2 * mean[c] / kPixels + 0.02);
    }
}

TEST_CASE("hair training: ten steps lower the loss, twice to the same bits, also when resumed")
{
    Progress::setEnabled(false);
    const test::TemporaryFolder folder;
    const HairPool pool = tinyPool();
    HairTrainSettings settings = tenSteps();
    const HairTraining plain = trainHairNet(test::context(), pool, settings);
    REQUIRE(plain.losses.size() == 10);
    // The blended radiance is close already: the first loss is small.
    CHECK(plain.losses[8] + plain.losses[9] < 0.8f * (plain.losses[0] + plain.losses[1]));
    CHECK(plain.parameters.report().stepsTaken == 10);
    REQUIRE(plain.validations.size() == 3); // steps 4, 8 and the last
    CHECK(plain.last.frames.size() == 1);
    CHECK(std::isfinite(plain.last.frames[0].network));
    CHECK(plain.last.frames[0].average64 < plain.last.frames[0].average4);

    // The latest checkpoint is that of step 6: as if the run had been killed after it.
    settings.checkpoint = folder.path() / "net.checkpoint";
    settings.checkpointEvery = 6;
    const HairTraining stopped = trainHairNet(test::context(), pool, settings);
    CHECK(stopped.parameters.download() == plain.parameters.download());
    settings.resume = true;
    const HairTraining resumed = trainHairNet(test::context(), pool, settings);
    CHECK(resumed.parameters.report().stepsTaken == 4);
    CHECK(resumed.parameters.download() == plain.parameters.download());
    CHECK(resumed.losses == plain.losses);
    CHECK(resumed.last.loss == plain.last.loss);

    settings.seed = 2;
    CHECK_THROWS_AS(trainHairNet(test::context(), pool, settings), FileError);
}

TEST_CASE("hair training: settings that make no training are refused")
{
    HairPool pool = tinyPool();
    HairTrainSettings settings = tenSteps();
    settings.crop = 12;
    CHECK_THROWS_AS(trainHairNet(test::context(), pool, settings), Error);
    settings.crop = 40;
    CHECK_THROWS_AS(trainHairNet(test::context(), pool, settings), Error);
    settings.crop = 16;
    settings.learningRate = 0.0;
    CHECK_THROWS_AS(trainHairNet(test::context(), pool, settings), Error);
    pool.frames.clear();
    settings.learningRate = 1e-3;
    CHECK_THROWS_AS(trainHairNet(test::context(), pool, settings), Error);
    HairTrainingSettings frame = tiny();
    frame.targetSamples = 12;
    CHECK_THROWS_AS(
        makeHairTrainingFrame(test::context(), hairTrainingLook(1, 0, false), frame, false), Error);
}
