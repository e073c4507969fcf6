// The CPU twin of the direct SG fit: gradient against finite differences, and fits with
// known answers.
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "passes/light_field_baselines.hpp"
#include "passes/sg_fit_irradiance.hpp"
#include "passes/sg_fit_reference.hpp"
#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg.h"
#include "shaders/shared/sg_diffuse.h"
#include "shaders/shared/sg_fit_types.h"
#include "tests/support/synthetic_lightfield.hpp"

using namespace strandlight;
using test::SyntheticRoom;

namespace {

struct Fitted
{
    FitProblem problem;
    SgField field;
};

Fitted fit(const CpuLightfield& lightfield, const Atlas& atlas, const FitSettings& settings)
{
    Fitted out;
    out.problem = buildFitProblem(atlas, lightfield, LightSet::Radiance, settings);
    out.field = fitLobesReference(out.problem, startFit(out.problem, settings.start), settings);
    return out;
}

// Largest |reconstruction - image| over texels, directions and channels.
float worstError(const Fitted& fitted)
{
    const LightFieldModel model = freeSgModel(fitted.problem, fitted.field, "fit", 0.0);
    const LightFieldModel truth = rawImageModel(fitted.problem);
    std::vector<glm::vec3> image(fitted.problem.directionCount()), expected(image.size());
    float worst = 0.0f;
    for (std::uint32_t t = 0; t < fitted.problem.texelCount(); ++t) {
        model.reconstruct(glm::uvec4(t), glm::vec4(1, 0, 0, 0), image);
        truth.reconstruct(glm::uvec4(t), glm::vec4(1, 0, 0, 0), expected);
        for (std::size_t d = 0; d < image.size(); ++d) {
            const glm::vec3 e = abs(image[d] - expected[d]);
            worst = std::max({worst, e.x, e.y, e.z});
        }
    }
    return worst;
}

bool allFinite(const SgField& field)
{
    for (const SgLobe& lobe : field.lobes)
        for (const float v : {lobe.axis.x, lobe.axis.y, lobe.axis.z, lobe.logSharpness,
                              lobe.amplitude.x, lobe.amplitude.y, lobe.amplitude.z})
            if (!std::isfinite(v))
                return false;
    return true;
}

} // namespace

TEST_CASE("fit gradient equals finite differences")
{
    SyntheticRoom room;
    room.grid = 3;
    room.size = 8;
    CpuLightfield lightfield = test::roomLightfield(room);
    lightfield.valid[4] = 0; // the weights of a missing image are part of the chain rule
    FitSettings settings;
    settings.lobes = 3;
    settings.directionsPerStep = 16;
    settings.peakSoftening = 0.3f;
    const FitProblem problem =
        buildFitProblem(test::gridAtlas(3), lightfield, LightSet::Radiance, settings);
    FitStateReference state = toReference(startFit(problem, FitStart::Fibonacci));
    // Texels must differ, or interpolation is not tested.
    std::mt19937 random(5);
    std::uniform_real_distribution<double> jitter(-0.3, 0.3);
    for (double& p : state.parameters)
        p += jitter(random);
    // Lobe 1 is not kept by one texel, lobe 2 by two neighbours.
    for (std::uint32_t k = 0; k < settings.lobes; ++k)
        for (std::uint32_t t = 0; t < problem.texelCount(); ++t)
            state.parameters[gpu::sgFitIndex(k, gpu::kSgFitDropped, t, problem.texelCount())] =
                (k == 1 && t == 1) || (k == 2 && (t == 5 || t == 8)) ? 1.0 : 0.0;
    const auto dropped = [&](std::size_t i) { // parameters of lobes that are not kept stay
        const std::size_t lobeFloats = problem.texelCount() * std::size_t(gpu::kSgFitLobeFloats);
        const std::size_t texel = i / 4 % problem.texelCount();
        return state.parameters[gpu::sgFitIndex(std::uint32_t(i / lobeFloats), gpu::kSgFitDropped,
                                                std::uint32_t(texel), problem.texelCount())] != 0.0;
    };
    for (state.step = 0; state.step < 6; ++state.step) {
        const FitCellGradients cells = sgFitCellsReference(problem, state, settings);
        const std::vector<double> gradient =
            sgFitGatherReference(problem, cells, state.step, settings);
        double largest = 0.0;
        for (const double g : gradient)
            largest = std::max(largest, std::abs(g));
        for (std::size_t i = 0; i < state.parameters.size(); ++i) {
            const bool flag = i / 4 / problem.texelCount() % 2 == 1 && i % 4 == 3;
            if (flag || dropped(i))
                continue;
            const double eps = 1.0e-6, centre = state.parameters[i];
            state.parameters[i] = centre + eps;
            const double above = sgFitCellsReference(problem, state, settings).loss();
            state.parameters[i] = centre - eps;
            const double below = sgFitCellsReference(problem, state, settings).loss();
            state.parameters[i] = centre;
            // Central differences in double: rounding ~ 1e-16 * loss / eps.
            const double numeric = (above - below) / (2.0 * eps);
            CHECK(std::abs(numeric - gradient[i]) <= 1e-5 * std::abs(numeric) + 1e-7 * largest);
        }
    }
}

TEST_CASE("constant light is kept")
{
    const glm::vec3 constant(0.5f, 1.0f, 2.0f);
    FitSettings settings;
    settings.steps = 600; // few texels start without blocks
    const Fitted fitted = fit(test::uniformLightfield(3, 16, [&](glm::vec3) { return constant; }),
                              test::gridAtlas(3), settings);
    const FitReportRow row =
        compareFits(fitted.problem, {}, {freeSgModel(fitted.problem, fitted.field, "fit", 0.0)})
            .rows[0];
    const double rms = std::sqrt((0.25 + 1.0 + 4.0) / 3.0);
    CHECK(row.texelRmse < 1e-2 * rms);
    CHECK(row.texelIrradiance < 1e-2);
}

TEST_CASE("one synthetic lobe is found again")
{
    const glm::vec3 axis = normalize(glm::vec3(0.4f, -0.3f, 0.8f));
    const auto radiance = [&](glm::vec3 d) {
        return glm::vec3(3.0f, 2.0f, 1.0f) * gpu::sgEvaluate(d, axis, 12.0f);
    };
    FitSettings settings;
    settings.lobes = 1;
    settings.steps = 600;
    settings.peakSoftening = 0.0f;
    const Fitted fitted =
        fit(test::uniformLightfield(2, 16, radiance), test::gridAtlas(2), settings);
    for (const SgLobe& lobe : fitted.field.lobes) {
        // RGB9E5 rounds each word by up to 1/1022 of its brightest channel; 256 of them average to
        // less than 1e-3.
        CHECK(dot(lobe.axis, axis) > 0.99999f);
        CHECK(std::exp(lobe.logSharpness) == doctest::Approx(12.0).epsilon(0.01));
        CHECK(lobe.amplitude.x == doctest::Approx(3.0).epsilon(0.01));
        CHECK(lobe.amplitude.z == doctest::Approx(1.0).epsilon(0.01));
    }
}

TEST_CASE("black light stays black, a firefly stays finite")
{
    FitSettings settings;
    settings.steps = 200;
    settings.lobes = 4;
    const Fitted black =
        fit(test::uniformLightfield(3, 8, [](glm::vec3) { return glm::vec3(0.0f); }),
            test::gridAtlas(3), settings);
    CHECK(allFinite(black.field));
    CHECK(black.problem.raisedScales == 9);
    CHECK(worstError(black) < 1e-6f);

    CpuLightfield firefly =
        test::uniformLightfield(3, 8, [](glm::vec3) { return glm::vec3(0.3f); });
    firefly.radiance[4 * 64 + 20] =
        gpu::packRgb9e5(glm::vec3(1.0e6f)); // clamped to 65408 by the format
    const Fitted bright = fit(firefly, test::gridAtlas(3), settings);
    CHECK(allFinite(bright.field));
}

TEST_CASE("a texel inside geometry is filled by its neighbours")
{
    SyntheticRoom room;
    room.grid = 5;
    room.size = 8;
    CpuLightfield lightfield = test::roomLightfield(room);
    FitSettings settings;
    settings.steps = 200;
    settings.directionsPerStep = 16;
    // What the dead texel holds must not matter.
    lightfield.valid[12] = 0;
    const Fitted first = fit(lightfield, test::gridAtlas(5), settings);
    for (std::size_t d = 0; d < 64; ++d)
        lightfield.radiance[12 * 64 + d] = gpu::packRgb9e5(glm::vec3(5000.0f));
    const Fitted second = fit(lightfield, test::gridAtlas(5), settings);
    CHECK(allFinite(first.field));
    for (std::size_t i = 0; i < first.field.lobes.size(); ++i)
        CHECK(first.field.lobes[i].amplitude == second.field.lobes[i].amplitude);
}

TEST_CASE("matched irradiance is the captured one")
{
    SyntheticRoom room;
    room.grid = 5;
    FitSettings settings;
    settings.steps = 100;
    Fitted fitted = fit(test::roomLightfield(room), test::gridAtlas(5), settings);
    CHECK(matchIrradiance(fitted.problem, fitted.field, 0) == 0);
    const FitProblem& problem = fitted.problem;
    double cosines = 0.0;
    for (const glm::vec4& direction : problem.directions)
        cosines += double(direction.z) * double(direction.w);
    for (std::uint32_t texel = 0; texel < problem.texelCount(); ++texel) {
        glm::dvec3 captured(0.0), given(0.0);
        for (std::uint32_t d = 0; d < problem.directionCount(); ++d)
            captured += double(problem.directions[d].z) * double(problem.directions[d].w) *
                        glm::dvec3(gpu::unpackRgb9e5(
                            problem.images[std::size_t(d) * problem.texelCount() + texel]));
        for (std::uint32_t k = 0; k < fitted.field.lobeCount; ++k) {
            const SgLobe& lobe = fitted.field.lobes[texel * fitted.field.lobeCount + k];
            given += glm::dvec3(lobe.amplitude) *
                     double(gpu::sgIrradiance(std::exp(lobe.logSharpness), lobe.axis.z));
        }
        captured *= double(gpu::kPi) / cosines;
        CHECK(glm::length(given - captured) < 1e-5 * glm::length(captured)); // fp32 amplitudes
    }
    CHECK(allFinite(fitted.field));

    // A factor beyond 2 is held, and counted.
    for (SgLobe& lobe : fitted.field.lobes)
        lobe.amplitude *= 4.0f;
    CHECK(matchIrradiance(fitted.problem, fitted.field, 0) == 3 * fitted.problem.texelCount());
}

TEST_CASE("light between texels: the joint fit beats texels apart and fixed directions")
{
    const SyntheticRoom room;
    const Atlas atlas = test::gridAtlas(room.grid);
    const CpuLightfield lightfield = test::roomLightfield(room);
    FitSettings joint;
    joint.steps = 300;
    FitSettings apart = joint;
    apart.cornerFraction = 1.0f;
    apart.smoothness = 0.0f;
    const Fitted fitted = fit(lightfield, atlas, joint);
    FitProbes probes = cellCentreProbes(fitted.problem, 1000);
    test::captureRoomProbes(room, atlas, probes);
    const FitReport report =
        compareFits(fitted.problem, probes,
                    {fixedSgModel(fitted.problem, 8),
                     freeSgModel(fitted.problem, fit(lightfield, atlas, apart).field, "apart", 0.0),
                     freeSgModel(fitted.problem, fitted.field, "joint", 0.0)});
    MESSAGE(report.text());
    CHECK(report.rows[2].interpolatedRmse <= report.rows[1].interpolatedRmse);
    CHECK(report.rows[2].interpolatedRmse <= 0.5 * report.rows[0].interpolatedRmse);
}
