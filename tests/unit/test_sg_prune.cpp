// Lobes that can be missed go, those that carry light stay, and what stays takes over.
#include <cmath>

#include <doctest/doctest.h>

#include "passes/sg_prune.hpp"
#include "tests/support/synthetic_lightfield.hpp"

using namespace strandlight;

namespace {

constexpr std::uint32_t kGrid = 4;

SgField sameEverywhere(const std::vector<SgLobe>& lobes)
{
    SgField field{.lobeCount = std::uint32_t(lobes.size())};
    for (std::uint32_t t = 0; t < kGrid * kGrid; ++t)
        field.lobes.insert(field.lobes.end(), lobes.begin(), lobes.end());
    return field;
}

FitProblem problemOf(float radiance, const FitSettings& settings)
{
    return buildFitProblem(
        test::gridAtlas(kGrid),
        test::uniformLightfield(kGrid, 8, [&](glm::vec3) { return glm::vec3(radiance); }),
        LightSet::Radiance, settings);
}

FitSettings twoLobes(float lobeError)
{
    FitSettings settings;
    settings.lobes = 2;
    settings.lobeError = lobeError;
    return settings;
}

} // namespace

TEST_CASE("prune: of two equal lobes one goes, and the other has the light of both")
{
    const FitSettings settings = twoLobes(0.01f);
    const FitProblem problem = problemOf(1.0f, settings);
    const SgLobe half{.logSharpness = -4.0f, .amplitude = glm::vec3(0.48f)};
    SgField field = sameEverywhere({half, half});
    pruneLobes(problem, settings, field);
    CHECK(field.keptCount() == kGrid * kGrid);
    for (std::size_t t = 0; t < field.kept.size(); ++t) {
        const std::uint32_t k = field.kept[t] == 1u ? 0 : 1;
        // The ridge costs half of 1e-5.
        CHECK(field.lobes[2 * t + k].amplitude.x == doctest::Approx(0.96f).epsilon(1e-4));
        CHECK(field.lobes[2 * t + 1 - k].amplitude == glm::vec3(0.0f));
    }
}

TEST_CASE("prune: where no light is no lobe stays, whatever the threshold")
{
    const FitSettings settings = twoLobes(1e-6f);
    const FitProblem problem = problemOf(0.0f, settings);
    SgField field = sameEverywhere({SgLobe{}, SgLobe{.axis = {1.0f, 0.0f, 0.0f}}});
    pruneLobes(problem, settings, field);
    CHECK(field.keptCount() == 0);
    FitStatistics statistics;
    countDropped(problem, field, statistics);
    CHECK(statistics.lobesDropped == 2 * kGrid * kGrid);
    CHECK(statistics.tiles == 4); // of 2 x 2 texels
    CHECK(statistics.darkTiles == 4);
}

TEST_CASE("prune: a lobe that the error cannot do without stays")
{
    const FitSettings settings = twoLobes(0.05f);
    const FitProblem problem = problemOf(1.0f, settings);
    // One lobe is nearly the light itself; the other adds a thousandth of it.
    SgField field = sameEverywhere(
        {SgLobe{.logSharpness = -4.0f, .amplitude = glm::vec3(0.95f)},
         SgLobe{.axis = {1.0f, 0.0f, 0.0f}, .logSharpness = 3.0f, .amplitude = glm::vec3(0.001f)}});
    pruneLobes(problem, settings, field);
    for (const std::uint32_t mask : field.kept)
        CHECK(mask == 1u);
}

TEST_CASE("prune: a lobe missing at a corner fades without turning")
{
    const glm::vec3 axis = glm::normalize(glm::vec3(0.6f, 0.0f, 0.8f));
    SgField field =
        sameEverywhere({SgLobe{.axis = axis, .logSharpness = 3.0f, .amplitude = glm::vec3(2.0f)}});
    field.tileSize = 1;
    field.kept.assign(kGrid * kGrid, 1u);
    field.kept[0] = 0u;
    field.lobes[0] = {.axis = {-1.0f, 0.0f, 0.0f}, .logSharpness = -9.0f}; // means nothing
    const SgLobe lobe = interpolateLobe(field, {0, 1, 4, 5}, {0.7f, 0.1f, 0.1f, 0.1f}, 0);
    CHECK(glm::distance(lobe.axis, axis) < 1e-6f);
    CHECK(lobe.logSharpness == doctest::Approx(3.0f));
    CHECK(lobe.amplitude.x == doctest::Approx(0.6f));
}
