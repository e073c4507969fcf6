// Blocks of texels: what they see, and the way back to the texels.
#include <algorithm>

#include <doctest/doctest.h>

#include "passes/sg_fit_coarse.hpp"
#include "shaders/shared/rgb9e5.h"
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
