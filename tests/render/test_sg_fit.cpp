// The direct SG fit on the device: against its twin, against known answers, and against itself.
#include <cmath>
#include <cstring>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "passes/fit_report.hpp"
#include "passes/sg_fit.hpp"
#include "passes/sg_fit_direct.hpp"
#include "passes/sg_fit_reference.hpp"
#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg.h"
#include "shaders/shared/sg_fit_types.h"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/synthetic_lightfield.hpp"

using namespace strandlight;

namespace {

struct RoomProblem
{
    test::SyntheticRoom room;
    Atlas atlas;
    FitProblem problem;
};

RoomProblem roomProblem(std::uint32_t grid, const FitSettings& settings)
{
    RoomProblem out;
    out.room.grid = grid;
    out.atlas = test::gridAtlas(grid);
    out.problem =
        buildFitProblem(out.atlas, test::roomLightfield(out.room), LightSet::Radiance, settings);
    return out;
}

// |a - b| / |b|, over all elements.
template <class A, class B> double relativeNorm(const A& a, const B& b)
{
    REQUIRE(a.size() == b.size());
    double difference = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        difference += (double(a[i]) - double(b[i])) * (double(a[i]) - double(b[i]));
        norm += double(b[i]) * double(b[i]);
    }
    return std::sqrt(difference / norm);
}

bool sameBytes(const SgField& a, const SgField& b)
{
    return a.lobes.size() == b.lobes.size() &&
           std::memcmp(a.lobes.data(), b.lobes.data(), a.lobes.size() * sizeof(SgLobe)) == 0;
}

} // namespace

TEST_CASE("fit steps on the device follow the twin")
{
    for (const std::uint32_t lobes : {1u, 3u, 8u}) {
        FitSettings settings;
        settings.lobes = lobes;
        settings.steps = 20;
        RoomProblem room = roomProblem(7, settings);
        room.problem.scales[24] = -room.problem.scales[24]; // one texel without image
        const FitState start = startFit(room.problem, FitStart::Fibonacci);
        DirectFit device(test::context(), room.problem, settings, start);
        FitStateReference twin = toReference(start);
        // The device's step from the twin's state, 10 steps on, when texels have come apart.
        for (int i = 0; i < 10; ++i)
            sgFitUpdateReference(room.problem, sgFitCellsReference(room.problem, twin, settings),
                                 settings, twin);
        device.run(10);
        // fp32 against double over ten steps of Adam, whose first steps are all of full length: a
        // gradient near zero may turn its sign. Measured up to 1.3e-3 of the norm; a wrong term
        // anywhere gives more than 0.1. The exact comparison is the single step below.
        CHECK(relativeNorm(device.state().parameters, twin.parameters) < 1e-2);

        DirectFit again(test::context(), room.problem, settings, fromReference(twin));
        const FitCellGradients expected = sgFitCellsReference(room.problem, twin, settings);
        again.run(1);
        CHECK(relativeNorm(again.gradients(), expected.gradients) < 1e-4);
        CHECK(again.loss() ==
              doctest::Approx(expected.loss() / double(expected.losses.size())).epsilon(1e-4));
        sgFitUpdateReference(room.problem, expected, settings, twin);
        CHECK(relativeNorm(again.state().parameters, twin.parameters) < 1e-4);
        CHECK(relativeNorm(again.state().firstMoments, twin.firstMoments) < 1e-4);
        CHECK(relativeNorm(again.state().secondMoments, twin.secondMoments) < 1e-3);
        CHECK(again.state().skippedSteps == 0);
    }
}

TEST_CASE("slices, chunks and a resume do not change a byte of the fit")
{
    FitSettings settings;
    settings.steps = 30;
    settings.lobes = 4;
    const RoomProblem room = roomProblem(6, settings);
    const FitState start = startFit(room.problem, settings.start);

    DirectFit whole(test::context(), room.problem, settings, start);
    whole.run(30);
    DirectFit sliced(test::context(), room.problem, settings, start);
    for (const std::uint32_t steps : {1u, 2u, 7u, 3u})
        sliced.run(steps);
    DirectFit resumed(test::context(), room.problem, settings, sliced.state());
    CHECK(resumed.step() == 13);
    resumed.run(17);
    CHECK(sameBytes(fieldFromState(room.problem, whole.state()),
                    fieldFromState(room.problem, resumed.state())));

    // Chunks cover every cell once and hold the texels that they name.
    std::uint32_t next = 0;
    for (const SgFitChunk& chunk : splitFitCells(room.problem, 14 * 256 * 4, 10)) {
        CHECK(chunk.firstCell == next);
        CHECK(chunk.cellCount <= 10);
        CHECK(chunk.texelCount <= 14);
        for (std::uint32_t cell = next; cell < next + chunk.cellCount; ++cell)
            for (int c = 0; c < 4; ++c) {
                const std::uint32_t texel = room.problem.cells.cornersOf(cell)[c];
                CHECK(texel - chunk.firstTexel < chunk.texelCount);
            }
        next += chunk.cellCount;
    }
    CHECK(next == room.problem.cells.cellCount);
}

TEST_CASE("known lights on the device: constant, one lobe, black, firefly")
{
    Progress::setEnabled(false);
    const Atlas atlas = test::gridAtlas(4);
    const auto fit = [&](const CpuLightfield& cpu, const FitSettings& settings) {
        const Lightfield lightfield = uploadLightfield(test::context(), cpu);
        return fitLobes(test::context(), atlas, lightfield, LightSet::Radiance, settings);
    };
    const glm::vec3 constant(0.5f, 1.0f, 2.0f);
    const CpuLightfield flat = test::uniformLightfield(4, 16, [&](glm::vec3) { return constant; });
    const FitProblem problem = buildFitProblem(atlas, flat, LightSet::Radiance, {});
    const FitReportRow row =
        compareFits(problem, {}, {freeSgModel(problem, fit(flat, {}), "fit", 0.0)}).rows[0];
    CHECK(row.texelRmse < 1e-2 * std::sqrt((0.25 + 1.0 + 4.0) / 3.0));
    CHECK(row.texelIrradiance < 1e-2);

    const glm::vec3 axis = normalize(glm::vec3(0.4f, -0.3f, 0.8f));
    FitSettings one;
    one.lobes = 1;
    one.peakSoftening = 0.0f;
    const SgField found = fit(test::uniformLightfield(4, 16,
                                                      [&](glm::vec3 d) {
                                                          return glm::vec3(3.0f, 2.0f, 1.0f) *
                                                                 gpu::sgEvaluate(d, axis, 12.0f);
                                                      }),
                              one);
    for (const SgLobe& lobe : found.lobes) {
        // RGB9E5 keeps nine bits of each word; 256 words average to better than 1e-3.
        CHECK(dot(lobe.axis, axis) > 0.99999f);
        CHECK(std::exp(lobe.logSharpness) == doctest::Approx(12.0).epsilon(0.01));
        CHECK(lobe.amplitude.y == doctest::Approx(2.0).epsilon(0.01));
    }

    FitSettings few;
    few.steps = 200;
    for (const SgLobe& lobe :
         fit(test::uniformLightfield(4, 16, [](glm::vec3) { return glm::vec3(0.0f); }), few)
             .lobes) {
        CHECK(std::isfinite(lobe.logSharpness));
        CHECK(std::isfinite(lobe.axis.x + lobe.axis.y + lobe.axis.z));
        CHECK(lobe.amplitude == glm::vec3(0.0f));
    }
    CpuLightfield firefly = flat;
    firefly.radiance[5 * 256 + 100] = gpu::packRgb9e5(glm::vec3(1.0e6f)); // 65408 in this format
    for (const SgLobe& lobe : fit(firefly, few).lobes) {
        CHECK(std::isfinite(lobe.logSharpness));
        CHECK(std::isfinite(lobe.axis.x + lobe.axis.y + lobe.axis.z));
        CHECK(std::isfinite(lobe.amplitude.x + lobe.amplitude.y + lobe.amplitude.z));
    }
}

TEST_CASE("between texels the joint fit beats texels apart; two runs are the same")
{
    Progress::setEnabled(false);
    FitSettings joint;
    joint.steps = 300;
    const RoomProblem room = roomProblem(12, joint);
    FitSettings apart = joint;
    apart.cornerFraction = 1.0f;
    apart.smoothness = 0.0f;
    FitStatistics statistics;
    const SgField first = fitLobes(test::context(), room.problem, joint, &statistics);
    CHECK(sameBytes(first, fitLobes(test::context(), room.problem, joint)));
    CHECK(statistics.skippedSteps == 0);
    CHECK(statistics.lastLoss < 0.2 * statistics.firstLoss);

    FitProbes probes = cellCentreProbes(room.problem, 1000);
    test::captureRoomProbes(room.room, room.atlas, probes);
    const FitReport report = compareFits(
        room.problem, probes,
        {fixedSgModel(room.problem, 8),
         freeSgModel(room.problem, fitLobes(test::context(), room.problem, apart), "apart", 0.0),
         freeSgModel(room.problem, first, "joint", statistics.seconds)});
    MESSAGE(report.text());
    CHECK(report.rows[2].interpolatedRmse <= report.rows[1].interpolatedRmse);
    CHECK(report.rows[2].interpolatedRmse <= 0.5 * report.rows[0].interpolatedRmse);
}

TEST_CASE("a start from blocks finds a better fit")
{
    Progress::setEnabled(false);
    FitSettings settings;
    settings.steps = 60;
    const RoomProblem room = roomProblem(24, settings);
    FitSettings single = settings;
    single.coarseLevels = 0;
    single.steps = 2 * settings.steps; // of all texels, where blocks take 1/2 + 1/4 of a step each
    FitStatistics fromBlocks, fromCommon;
    const SgField blocks = fitLobes(test::context(), room.problem, settings, &fromBlocks);
    const SgField common = fitLobes(test::context(), room.problem, single, &fromCommon);
    CHECK(sameBytes(blocks, fitLobes(test::context(), room.problem, settings)));
    CHECK(fromBlocks.firstLoss < 0.5 * fromCommon.firstLoss);
    FitProbes probes = cellCentreProbes(room.problem, 200);
    test::captureRoomProbes(room.room, room.atlas, probes);
    const FitReport report =
        compareFits(room.problem, probes,
                    {freeSgModel(room.problem, common, "common start", fromCommon.seconds),
                     freeSgModel(room.problem, blocks, "from blocks", fromBlocks.seconds)});
    MESSAGE(report.text());
    CHECK(report.rows[1].interpolatedRmse < report.rows[0].interpolatedRmse);
    CHECK(report.rows[1].texelRmse < report.rows[0].texelRmse);
}

TEST_CASE("the encoder learns the room, and refining its lobes helps")
{
    Progress::setEnabled(false);
    FitSettings settings;
    settings.mode = FitMode::Cnn;
    settings.cnnSteps = 40;
    settings.steps = 100;
    RoomProblem room = roomProblem(8, settings);
    room.problem.scales[27] =
        -room.problem.scales[27]; // a texel inside geometry gets its neighbours' lobes
    FitStatistics statistics;
    const SgField lobes = fitLobes(test::context(), room.problem, settings, &statistics);
    CHECK(statistics.lastLoss < 0.7 * statistics.firstLoss);
    CHECK(statistics.skippedSteps == 0);
    CHECK(statistics.texelsWithoutImage == 1);
    CHECK(lobes.lobes[27 * 8].amplitude != glm::vec3(0.0f));
    CHECK(sameBytes(lobes, fitLobes(test::context(), room.problem, settings)));

    settings.mode = FitMode::CnnRefine;
    const SgField refined = fitLobes(test::context(), room.problem, settings);
    const FitReport report = compareFits(room.problem, {},
                                         {freeSgModel(room.problem, lobes, "cnn", 0.0),
                                          freeSgModel(room.problem, refined, "cnn+refine", 0.0)});
    CHECK(report.rows[1].texelRmse < report.rows[0].texelRmse);
}

TEST_CASE("a fit refuses what does not belong together")
{
    const CpuLightfield flat =
        test::uniformLightfield(3, 8, [](glm::vec3) { return glm::vec3(1.0f); });
    CHECK_THROWS_AS(buildFitProblem(test::gridAtlas(4), flat, LightSet::Radiance, {}), Error);
    CHECK_THROWS_AS(buildFitProblem(test::gridAtlas(3), flat, LightSet::Environment, {}), Error);
    FitSettings settings;
    settings.lobes = 33;
    CHECK_THROWS_AS(buildFitProblem(test::gridAtlas(3), flat, LightSet::Radiance, settings), Error);
    const FitProblem problem = buildFitProblem(test::gridAtlas(3), flat, LightSet::Radiance, {});
    FitState foreign;
    foreign.parameters.resize(8);
    FitCheckpoint checkpoint;
    checkpoint.resume = &foreign;
    CHECK_THROWS_AS(fitLobes(test::context(), problem, {}, nullptr, &checkpoint), Error);
    CHECK_THROWS_AS(fitModeFrom("guess"), Error);
    CHECK((fitModeFrom("cnn+refine") == FitMode::CnnRefine));
}
