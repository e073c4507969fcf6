// What light sampling chooses from.
#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "engine/base/error.hpp"
#include "engine/scene/emitters.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "engine/scene/procedural.hpp"
#include "shaders/shared/environment.h"
#include "shaders/shared/light_types.h"
#include "shaders/shared/sampling.h"

using namespace strandlight;

namespace {

// Probability of each index by the table's own columns.
std::vector<double> exactProbabilities(const AliasTable& table)
{
    const std::size_t n = table.thresholds.size();
    std::vector<double> p(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        p[i] += double(table.thresholds[i]) / double(n);
        p[table.others[i]] += (1.0 - double(table.thresholds[i])) / double(n);
    }
    return p;
}

} // namespace

TEST_CASE("alias table: probabilities are the weights")
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const std::size_t n : {1u, 2u, 7u, 1000u}) {
        std::vector<double> weights(n);
        for (double& w : weights)
            w = unit(random) < 0.3 ? 0.0 : std::pow(unit(random), 8.0);
        weights[0] = 0.5;
        const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
        const AliasTable table = buildAliasTable(weights);
        const std::vector<double> p = exactProbabilities(table);
        for (std::size_t i = 0; i < n; ++i) {
            // Thresholds are fp32: 6e-8 of a column each.
            REQUIRE(std::abs(p[i] - weights[i] / total) < 1e-6);
            REQUIRE(double(table.probabilities[i]) == doctest::Approx(weights[i] / total));
            if (weights[i] == 0.0)
                REQUIRE(p[i] == 0.0);
        }
    }
    CHECK_THROWS_AS(buildAliasTable({0.0, 0.0}), Error);
    CHECK_THROWS_AS(buildAliasTable({1.0, -1.0}), Error);
    CHECK_THROWS_AS(buildAliasTable({std::nan("")}), Error);
}

TEST_CASE("emitters: densities integrate to one over all emitting triangles")
{
    for (const Scene& scene : {buildRoomScene(), buildFurnaceScene(0.5f)}) {
        const Bvh bvh = buildBvh(scene);
        const EmitterTable table = buildEmitterTable(scene, bvh, packTextures(scene));
        double total = 0.0;
        for (std::uint32_t slot = 0; slot < bvh.order.size(); ++slot) {
            const TriangleCorners t = triangleCorners(bvh, slot);
            total += 0.5 * double(glm::length(glm::cross(t.b - t.a, t.c - t.a))) *
                     double(table.triangleDensity[slot]);
        }
        CHECK(total == doctest::Approx(1.0).epsilon(1e-5));
        for (const glm::uvec4& entry : table.entries)
            CHECK(scene.materials[scene.triangleMaterials[bvh.order[entry.z]]].emissive !=
                  glm::vec3(0.0f));
    }
    const Scene dark = buildDarkBoxScene();
    CHECK(buildEmitterTable(dark, buildBvh(dark), packTextures(dark)).entries.empty());
}

TEST_CASE("emitters: the environment's densities integrate to one over the sphere")
{
    Environment environment;
    environment.latLong = CpuImage(96, 48, glm::vec4(0.1f));
    environment.latLong.at(70, 10) = glm::vec4(500.0f);
    for (std::uint32_t k = 0; k < 9; ++k)
        environment.latLong.at(2 + k % 3, 39 + k / 3) = glm::vec4(0.0f);
    const EnvironmentGrid grid = buildEnvironmentGrid(environment);
    REQUIRE(grid.width == 96);
    REQUIRE(grid.height == 48);
    // Density over uv, mean over all cells.
    double mean = 0.0;
    for (const glm::vec4& cell : grid.cells)
        mean += double(cell.z) / double(grid.cells.size());
    CHECK(mean == doctest::Approx(1.0).epsilon(1e-5));
    CHECK(grid.cells[std::size_t(40) * 96 + 3].z == 0.0f);
    CHECK(grid.cells[std::size_t(10) * 96 + 70].z > 100.0f);
    CHECK(grid.cells[std::size_t(10) * 96 + 71].z > 20.0f); // bilinear lookups bleed
}

TEST_CASE("scene features: what a scene has not is not asked for")
{
    const TracedScene dark = prepareScene(buildDarkBoxScene());
    CHECK(
        (dark.features & (gpu::kFeatureEmitters | gpu::kFeatureEnvironment | gpu::kFeaturePunctual |
                          gpu::kFeatureAlphaMask | gpu::kFeatureBaseColorTexture)) == 0u);
    CHECK(dark.environment.empty());
    CHECK(dark.textures.words.empty());
    CHECK(dark.lights.empty());
    Scene lit = buildDarkBoxScene();
    lit.lights.push_back({});
    lit.environment = Environment{CpuImage(8, 4, glm::vec4(1.0f))};
    const TracedScene bright = prepareScene(lit);
    CHECK((bright.features & gpu::kFeatureEmitters) != 0u);
    CHECK((bright.features & gpu::kFeatureEnvironment) != 0u);
    CHECK(bright.environment.size() == 8 * 4 * 2);
}
