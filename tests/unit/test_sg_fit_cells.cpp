// What the direct fit interpolates together, and the directions that it looks at.
#include <array>
#include <set>

#include <doctest/doctest.h>

#include "passes/sg_fit_cells.hpp"
#include "shaders/shared/sg_fit_types.h"

using namespace strandlight;

TEST_CASE("fit cells stay inside charts and every texel has one")
{
    // Two charts side by side, 3 x 2 and 2 x 2, and a lone texel.
    Atlas atlas;
    for (const auto [x, y, chart] : {std::array{1u, 1u, 0u},
                                     {2u, 1u, 0u},
                                     {3u, 1u, 0u},
                                     {4u, 1u, 1u},
                                     {5u, 1u, 1u},
                                     {1u, 2u, 0u},
                                     {2u, 2u, 0u},
                                     {3u, 2u, 0u},
                                     {4u, 2u, 1u},
                                     {5u, 2u, 1u},
                                     {9u, 9u, 2u}}) {
        AtlasTexel texel;
        texel.x = x;
        texel.y = y;
        texel.chart = chart;
        atlas.texels.push_back(texel);
    }
    const FitCells cells = buildFitCells(atlas);
    REQUIRE(cells.cellCount == 4);
    CHECK(cells.cornersOf(0) == glm::uvec4(0, 1, 5, 6));
    CHECK(cells.cornersOf(1) == glm::uvec4(1, 2, 6, 7));
    CHECK(cells.cornersOf(2) == glm::uvec4(3, 4, 8, 9));
    CHECK(cells.cornersOf(3) == glm::uvec4(10));
    for (std::uint32_t t = 0; t < cells.texelCount; ++t) {
        int found = 0;
        for (std::uint32_t c = 0; c < 4; ++c) {
            const std::uint32_t entry = cells.gather[c * cells.texelCount + t];
            if (entry == gpu::kSgFitNone)
                continue;
            ++found;
            CHECK((entry & 3u) == c);
            CHECK(cells.corners[c * cells.cellCount + (entry >> 2)] == t);
        }
        CHECK(found >= 1);
    }
    CHECK(cells.neighbours[1 * cells.texelCount + 2] ==
          gpu::kSgFitNone); // +x of texel 2 is another chart
    CHECK(cells.neighbours[1 * cells.texelCount + 1] == 2);
    CHECK(cells.neighbours[3 * cells.texelCount + 0] == 5);
}

TEST_CASE("every direction is looked at once per round")
{
    const std::uint32_t perStep = 64, directions = 256;
    std::vector<int> seen(directions, 0);
    for (std::uint32_t step = 8; step < 12; ++step)
        for (std::uint32_t k = 0; k < perStep; ++k)
            ++seen[gpu::sgFitDirection(k, step, perStep, directions, 7)];
    for (const int count : seen)
        CHECK(count == 1);
}
