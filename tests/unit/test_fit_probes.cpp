// Points between texels: where the fit study looks must be where shading would interpolate.
#include <doctest/doctest.h>

#include <algorithm>

#include "engine/scene/atlas.hpp"
#include "engine/scene/scene_loader.hpp"
#include "passes/fit_probes.hpp"

using namespace strandlight;

TEST_CASE("probes lie on the surface in the middle of their four texels")
{
    const Scene scene = loadScene("builtin:room");
    const Atlas atlas = buildAtlas(scene, {.resolution = 64});
    const FitCells cells = buildFitCells(atlas);
    FitProbes probes;
    for (std::uint32_t cell = 0; cell < cells.cellCount; ++cell) {
        const glm::uvec4 corners = cells.cornersOf(cell);
        if (corners.x == corners.y)
            continue; // a texel without neighbours
        probes.texels.push_back(corners);
        probes.weights.push_back(glm::vec4(0.25f));
    }
    const std::size_t asked = probes.texels.size();
    const std::vector<AtlasTexel> places = locateProbes(atlas, probes);
    REQUIRE(places.size() == probes.texels.size());
    REQUIRE(places.size() == probes.weights.size());
    CHECK(places.size() > asked / 2); // only ragged borders drop out

    // Texels on a border are sampled up to half a diagonal off their centre, so the mean of four
    // may be off by as much; curved charts stretch it further. Four fifths of all lie much nearer.
    const double texel = 1.0 / double(atlas.texelsPerMetre);
    std::vector<double> distances;
    for (std::size_t p = 0; p < places.size(); ++p) {
        glm::vec3 mean(0.0f);
        for (int c = 0; c < 4; ++c)
            mean += 0.25f *
                    evaluateAtlasTexel(scene, atlas, atlas.texels[probes.texels[p][c]]).position;
        const AtlasPoint point = evaluateAtlasTexel(scene, atlas, places[p]);
        distances.push_back(double(glm::length(point.position - mean)) / texel);
        const glm::vec2 b = places[p].barycentric;
        CHECK(b.x >= -1e-5f);
        CHECK(b.y >= -1e-5f);
        CHECK(b.x + b.y <= 1.0f + 1e-5f);
    }
    std::sort(distances.begin(), distances.end());
    CHECK(distances[distances.size() * 4 / 5] < 0.3);
    CHECK(distances.back() < 1.5);
}
