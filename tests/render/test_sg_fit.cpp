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
        // gradient near zero may turn its sign. Measured 2e-5; the bound leaves room for other
        // devices' exp.
        CHECK(relativeNorm(device.state().parameters, twin.parameters) < 1e-3);

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
