// Blocks of texels: what they see, and the way back to the texels.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "passes/sg_fit_coarse.hpp"
#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg.h"
#include "tests/support/synthetic_lightfield.hpp"

using namespace strandlight;

namespace {

// Texels of two charts that share the column of blocks x = 1: 4 x 2 and 1 x 2 texels, red from 1 to
// 10 in every direction.
FitProblem twoCharts()
{
    FitProblem problem;
    std::vector<glm::uvec3> places;
    for (std::uint32_t y = 0; y < 2; ++y)
        for (std::uint32_t x = 0; x < 5; ++x)
            places.emplace_back(x < 4 ? x : 3u, x < 4 ? y : y + 2, x < 4 ? 0u : 1u);
    places[4].y = 1; // of the second chart, in the same block as texels of the first
    problem.cells = buildFitCells(places);
    problem.lobes = 2;
    problem.size = 4;
    problem.directions = fitDirections(4);
    for (std::uint32_t d = 0; d < problem.directionCount(); ++d)
        for (std::uint32_t t = 0; t < places.size(); ++t)
            problem.images.push_back(gpu::packRgb9e5(glm::vec3(float(t + 1), 0.0f, 0.0f)));
    for (std::uint32_t t = 0; t < places.size(); ++t)
        problem.scales.push_back(float(t + 1) / 3.0f);
    return problem;
}

std::uint32_t blockAt(const CoarseProblem& coarse, glm::uvec3 place)
{
    const std::uint32_t block =
        FitPlaces(coarse.problem.cells.places).at(int(place.x), int(place.y), place.z);
    REQUIRE(block < coarse.problem.texelCount());
    return block;
}

float redOf(const CoarseProblem& coarse, std::uint32_t block, std::uint32_t direction)
{
    const std::size_t index = std::size_t(direction) * coarse.problem.texelCount() + block;
    return gpu::unpackRgb9e5(coarse.problem.images[index]).x;
}

} // namespace

TEST_CASE("blocks are means of a chart's own texels")
{
    FitProblem fine = twoCharts();
    const CoarseProblem coarse = coarsen(fine);
    REQUIRE(coarse.problem.texelCount() == 4); // 2 of the first chart, 2 of the second
    CHECK(coarse.problem.directionCount() == fine.directionCount());
    const std::uint32_t left = blockAt(coarse, {0, 0, 0}), right = blockAt(coarse, {1, 0, 0});
    const std::uint32_t foreign = blockAt(coarse, {1, 0, 1});
    for (const std::uint32_t d : {0u, 7u, 15u}) {
        CHECK(redOf(coarse, left, d) == doctest::Approx((1 + 2 + 6 + 7) / 4.0).epsilon(4e-3));
        CHECK(redOf(coarse, right, d) == doctest::Approx((3 + 4 + 8 + 9) / 4.0).epsilon(4e-3));
        CHECK(redOf(coarse, foreign, d) == doctest::Approx(5.0).epsilon(4e-3));
    }
    CHECK(coarse.problem.scales[left] == doctest::Approx(4.0 / 3.0));

    fine.scales[1] = fine.scales[6] = -7.0f; // inside geometry: no image
    fine.scales[4] = -7.0f;
    const CoarseProblem holes = coarsen(fine);
    CHECK(redOf(holes, left, 3) == doctest::Approx((1 + 6) / 2.0).epsilon(4e-3));
    CHECK(holes.problem.scales[left] == doctest::Approx(3.5 / 3.0));
    CHECK(redOf(holes, foreign, 3) == 0.0f);
    CHECK(holes.problem.scales[foreign] == -7.0f);
}

TEST_CASE("lobes of blocks reach the texels: bilinear, inside a chart, as bright as the texel")
{
    FitProblem fine;
    fine.cells = buildFitCells(test::gridAtlas(8));
    fine.lobes = 1;
    fine.size = 1;
    fine.directions = fitDirections(1);
    fine.images.assign(64, gpu::packRgb9e5(glm::vec3(1.0f)));
    fine.scales.assign(64, 1.0f);
    fine.scales[9] = 3.0f;
    const CoarseProblem coarse = coarsen(fine);
    SgField blocks;
    blocks.lobeCount = 1;
    for (std::uint32_t b = 0; b < coarse.problem.texelCount(); ++b) {
        const glm::uvec3 place = coarse.problem.cells.places[b];
        blocks.lobes.push_back({glm::vec3(0.0f, 0.6f, 0.8f), float(place.x) - 2.0f * float(place.y),
                                glm::vec3(2.0f * coarse.problem.scales[b])});
    }
    const SgField texels = interpolateBlocks(fine, coarse, blocks);
    REQUIRE(texels.lobes.size() == 64);
    for (std::uint32_t t = 0; t < 64; ++t) {
        const glm::uvec3 place = fine.cells.places[t];
        const SgLobe& lobe = texels.lobes[t];
        CHECK(glm::length(lobe.axis - glm::vec3(0.0f, 0.6f, 0.8f)) < 1e-6f);
        CHECK(lobe.amplitude.x == doctest::Approx(2.0f * fine.scales[t]));
        const auto inBlocks = [](std::uint32_t x) { // held at the chart's border
            return std::clamp((float(x) + 0.5f) / 2.0f - 0.5f, 1.0f, 4.0f);
        };
        CHECK(lobe.logSharpness ==
              doctest::Approx(inBlocks(place.x) - 2.0f * inBlocks(place.y)).epsilon(1e-5));
    }
}

TEST_CASE("lobes of a start are as bright as the texel's image")
{
    FitProblem problem;
    problem.cells = buildFitCells(test::gridAtlas(2));
    problem.lobes = 2;
    problem.size = 8;
    problem.directions = fitDirections(8);
    problem.scales = {1.0f, 1e-4f, -1.0f, 1.0f};
    SgField field;
    field.lobeCount = 2;
    for (int t = 0; t < 4; ++t) {
        field.lobes.push_back({glm::vec3(0.0f, 0.6f, 0.8f), 1.0f, glm::vec3(1.0f, 2.0f, 0.5f)});
        field.lobes.push_back({glm::vec3(0.0f, 0.0f, 1.0f), 4.0f, glm::vec3(0.3f)});
    }
    // Texel 0 saw three times its lobes, texel 1 nothing, texel 2 has no image, texel 3 saw
    // something else.
    for (const glm::vec4& d : problem.directions) {
        glm::vec3 light(0.0f);
        for (int k = 0; k < 2; ++k)
            light +=
                field.lobes[k].amplitude * gpu::sgEvaluate(glm::vec3(d), field.lobes[k].axis,
                                                           std::exp(field.lobes[k].logSharpness));
        for (const glm::vec3& seen :
             {3.0f * light, glm::vec3(0.0f), light, glm::vec3(d.x * d.x, 0.1f, 0.4f)})
            problem.images.push_back(gpu::packRgb9e5(seen));
    }
    const SgField before = field;
    const FitSettings settings;
    matchBrightness(problem, settings, field);
    CHECK(field.lobes[0].amplitude.y == doctest::Approx(6.0).epsilon(4e-3));
    CHECK(field.lobes[1].amplitude.x == doctest::Approx(0.9).epsilon(4e-3));
    CHECK(field.lobes[2].amplitude == glm::vec3(0.0f));
    CHECK(field.lobes[4].amplitude == before.lobes[4].amplitude);
    // Of all factors the best: the weighted squared error is stationary.
    const auto error = [&](float factor) {
        double sum = 0.0;
        for (std::size_t i = 0; i < problem.directions.size(); ++i) {
            const glm::vec4& d = problem.directions[i];
            const glm::vec3 seen = gpu::unpackRgb9e5(problem.images[4 * i + 3]);
            glm::vec3 left = -seen;
            for (int k = 6; k < 8; ++k)
                left += factor * field.lobes[k].amplitude *
                        gpu::sgEvaluate(glm::vec3(d), field.lobes[k].axis,
                                        std::exp(field.lobes[k].logSharpness));
            const float softened =
                d.w / (1.0f + settings.peakSoftening * (seen.x + seen.y + seen.z) / 3.0f);
            sum += double(softened * glm::dot(left, left));
        }
        return sum;
    };
    CHECK(error(1.0f) < error(0.95f));
    CHECK(error(1.0f) < error(1.05f));
}
