// The rivals of free SGs: least squares with known answers.
#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "passes/fit_report.hpp"
#include "passes/least_squares.hpp"
#include "passes/light_field_baselines.hpp"
#include "tests/support/synthetic_lightfield.hpp"

using namespace strandlight;

namespace {

FitProblem problemOf(const CpuLightfield& field, std::uint32_t grid)
{
    return buildFitProblem(test::gridAtlas(grid), field, LightSet::Radiance, {});
}

double texelRmse(const FitProblem& problem, const LightFieldModel& model)
{
    return compareFits(problem, {}, {model}).rows[0].texelRmse;
}

} // namespace

TEST_CASE("non-negative least squares: inside and on the border of the positive quadrant")
{
    // min |x - (1, 2)|^2: the answer itself. min |x - (1, -2)|^2 with coupling 0.5: x1 = 0, x0 = 1.
    CHECK(solveNonNegative({1, 0, 0, 1}, {1, 2})[1] == doctest::Approx(2.0));
    const std::vector<double> border = solveNonNegative({1, 0.5, 0.5, 1}, {1, -2});
    CHECK(border[0] == doctest::Approx(1.0));
    CHECK(border[1] == 0.0);
    CHECK(solveNonNegative({0, 0, 0, 1}, {1, 1})[0] == 0.0); // an empty column stays out
}

TEST_CASE("spherical harmonics keep what lies in their span")
{
    const FitProblem linear =
        problemOf(test::uniformLightfield(
                      2, 8, [](glm::vec3 d) { return glm::vec3(1.0f + 0.5f * d.x + 0.2f * d.z); }),
                  2);
    const FitProblem quadratic = problemOf(
        test::uniformLightfield(
            2, 8, [](glm::vec3 d) { return glm::vec3(1.0f + d.x * d.y - 0.3f * d.z * d.z); }),
        2);
    // RGB9E5 keeps nine bits: 1/1022 of values up to 1.6.
    CHECK(texelRmse(linear, sphericalHarmonicModel(linear, 2)) < 1.6e-3);
    CHECK(texelRmse(quadratic, sphericalHarmonicModel(quadratic, 3)) < 1.6e-3);
    CHECK(texelRmse(quadratic, sphericalHarmonicModel(quadratic, 2)) > 0.05);
    CHECK_THROWS_AS(sphericalHarmonicModel(linear, 4), Error);
}

TEST_CASE("baselines as lobes are the same light")
{
    const test::SyntheticRoom room;
    const Atlas atlas = test::gridAtlas(room.grid);
    const FitProblem problem =
        buildFitProblem(atlas, test::roomLightfield(room), LightSet::Radiance, {});
    const auto between = glm::uvec4(14, 15, 26, 27);
    for (const LightFieldModel& model :
         {sphericalHarmonicModel(problem, 2), sphericalHarmonicModel(problem, 3),
          fixedSgModel(problem, 8)}) {
        CAPTURE(model.name);
        REQUIRE(model.lobes);
        const LightFieldModel lobes = freeSgModel(problem, *model.lobes, "lobes", 0.0);
        std::vector<glm::vec3> image(problem.directionCount()), same(problem.directionCount());
        model.reconstruct(between, glm::vec4(0.25f), image);
        lobes.reconstruct(between, glm::vec4(0.25f), same);
        double difference = 0.0, sum = 0.0;
        for (std::size_t d = 0; d < image.size(); ++d) {
            difference += double(glm::dot(image[d] - same[d], image[d] - same[d]));
            sum += double(glm::dot(image[d], image[d]));
        }
        // What 32 lobes of sharpness 2 leave of a quadratic; fixed lobes are lobes already.
        CHECK(std::sqrt(difference / sum) < (model.name == "8 fixed SGs" ? 1e-5 : 1e-2));
    }
    CHECK_FALSE(rawImageModel(problem).lobes);
}

TEST_CASE("raw images are exact at texels, and the report measures between them")
{
    const test::SyntheticRoom room;
    const Atlas atlas = test::gridAtlas(room.grid);
    const CpuLightfield field = test::roomLightfield(room);
    const FitProblem problem = buildFitProblem(atlas, field, LightSet::Radiance, {});
    FitProbes probes = cellCentreProbes(problem, 1000);
    CHECK(probes.texels.size() == 121);
    test::captureRoomProbes(room, atlas, probes);
    const FitReport report =
        compareFits(problem, probes,
                    {rawImageModel(problem), sphericalHarmonicModel(problem, 2),
                     sphericalHarmonicModel(problem, 3), fixedSgModel(problem, 8)});
    MESSAGE(report.text());
    CHECK(report.rows[0].texelRmse == 0.0);
    CHECK(report.rows[0].interpolatedRmse > 0.2); // parallax: a cross-fade is not the truth
    CHECK(report.rows[2].texelRmse < report.rows[1].texelRmse);
    // Least squares cannot be worse than black.
    for (const FitReportRow& row : report.rows)
        CHECK(row.texelRmse < report.signalRms);
}
