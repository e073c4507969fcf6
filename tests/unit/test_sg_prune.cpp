// Lobes that can be missed go, those that carry light stay, and what stays takes over.
#include <cmath>

#include <doctest/doctest.h>

#include "passes/sg_fit_irradiance.hpp"
#include "passes/sg_prune.hpp"
#include "passes/texel_gloss.hpp"
#include "shaders/shared/sg_diffuse.h"
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

TEST_CASE("prune: a surface that reflects sharply keeps what a rough one gives up")
{
    const FitSettings settings = twoLobes(0.006f); // enough for some, not for all
    FitProblem problem = problemOf(1.0f, settings);
    SgField field = sameEverywhere(
        {SgLobe{.logSharpness = -4.0f, .amplitude = glm::vec3(0.95f)},
         SgLobe{.axis = {1.0f, 0.0f, 0.0f}, .logSharpness = 3.0f, .amplitude = glm::vec3(0.1f)}});
    problem.gloss.assign(kGrid * kGrid, 0.0f);
    for (std::size_t t = 0; t < kGrid * kGrid / 2; ++t) // whole tiles
        problem.gloss[t] = 1.0f;
    pruneLobes(problem, settings, field);
    std::size_t glossy = 0, rough = 0;
    for (std::size_t t = 0; t < field.kept.size(); ++t)
        (problem.gloss[t] > 0.0f ? glossy : rough) += field.kept[t] == 3u ? 1 : 0;
    CHECK(glossy == kGrid * kGrid / 2);
    CHECK(rough < kGrid * kGrid / 2);
}

TEST_CASE("prune: what is left sends the light of all")
{
    const FitSettings settings = twoLobes(0.5f);
    const FitProblem problem = problemOf(1.0f, settings);
    const SgLobe wide{.logSharpness = -4.0f, .amplitude = glm::vec3(0.7f, 0.5f, 0.3f)};
    const SgLobe narrow{
        .axis = {0.6f, 0.0f, 0.8f}, .logSharpness = 2.0f, .amplitude = glm::vec3(0.2f, 0.4f, 0.6f)};
    const SgField whole = sameEverywhere({wide, narrow});
    SgField field = whole;
    field.tileSize = 1;
    field.kept.assign(kGrid * kGrid, 1u);
    for (std::size_t t = 0; t < field.kept.size(); ++t)
        field.lobes[2 * t + 1].amplitude = glm::vec3(0.0f);
    matchIrradianceOf(problem, whole, field);
    const auto irradiance = [](const SgField& f, std::size_t t) {
        glm::vec3 sum(0.0f);
        for (std::size_t k = 2 * t; k < 2 * t + 2; ++k)
            sum += f.lobes[k].amplitude *
                   gpu::sgIrradiance(std::exp(f.lobes[k].logSharpness), f.lobes[k].axis.z);
        return sum;
    };
    for (std::size_t t = 0; t < field.kept.size(); ++t)
        CHECK(glm::distance(irradiance(field, t), irradiance(whole, t)) < 1e-5f);
}

TEST_CASE("gloss: F0 of what reflects sharply, nothing of rough or matte surfaces")
{
    Scene scene;
    scene.vertices.resize(3);
    scene.triangles = {{0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}};
    scene.triangleMaterials = {0, 1, 2, 3};
    scene.materials.resize(4);
    scene.materials[0] = {.baseColor = {0.2f, 0.9f, 0.5f, 1.0f}, .metallic = 1, .roughness = 0.25f};
    scene.materials[1] = {.metallic = 0.0f, .roughness = 0.5f};
    scene.materials[2] = {.metallic = 1.0f, .roughness = 1.0f};
    scene.materials[3] = {.metallic = 0.0f, .roughness = 0.0f, .specular = 0.0f};
    Atlas atlas;
    for (std::uint32_t t = 0; t < 4; ++t)
        atlas.texels.push_back({.triangle = t});
    const std::vector<float> gloss = texelGloss(scene, atlas);
    CHECK(gloss[0] == doctest::Approx(0.9 * 0.75));
    CHECK(gloss[1] == doctest::Approx(0.04 * 0.5));
    CHECK(gloss[2] == 0.0f);
    CHECK(gloss[3] == 0.0f);
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
