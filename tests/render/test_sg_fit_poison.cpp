// The direct fit with NaN or infinity in what it starts from: counted, held where it is, never
// hidden by a clamp.
#include <doctest/doctest.h>

#include <cmath>

#include "passes/sg_fit_direct.hpp"
#include "shaders/shared/sg_fit_types.h"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/synthetic_lightfield.hpp"

using namespace strandlight;

namespace {

struct Fixture
{
    FitSettings settings;
    FitProblem problem;
    FitState start;
};

Fixture makeFixture()
{
    Fixture f;
    f.settings.lobes = 3;
    f.settings.steps = 20;
    f.problem = buildFitProblem(
        test::gridAtlas(5),
        test::uniformLightfield(5, 8, [](glm::vec3 d) { return glm::vec3(1.0f + d.x, 1.0f, d.z); }),
        LightSet::Radiance, f.settings);
    f.start = startFit(f.problem, FitStart::Fibonacci);
    return f;
}

FitState runFrom(const Fixture& f, const FitState& start, std::uint32_t steps)
{
    DirectFit fit(test::context(), f.problem, f.settings, start);
    fit.run(steps);
    return fit.state();
}

std::size_t nonFinite(const std::vector<float>& values)
{
    std::size_t count = 0;
    for (const float v : values)
        count += std::isfinite(v) ? 0 : 1;
    return count;
}

} // namespace

TEST_CASE("direct fit: a poisoned moment holds its lobe and is counted in every step")
{
    const Fixture f = makeFixture();
    CHECK_EQ(runFrom(f, f.start, 5).skippedSteps, 0);
    const std::uint32_t texel = 12, lobe = 1, texels = f.problem.texelCount();
    for (const float poison : {NAN, INFINITY})
        for (const std::uint32_t component :
             {gpu::kSgFitAxis, gpu::kSgFitSharpness, gpu::kSgFitAmplitude}) {
            CAPTURE(component);
            FitState start = f.start;
            start.firstMoments[gpu::sgFitIndex(lobe, component, texel, texels)] = poison;
            const FitState end = runFrom(f, start, 5);
            CHECK_EQ(end.skippedSteps, 5);
            CHECK_EQ(nonFinite(end.parameters), 0);
            for (std::uint32_t c = 0; c < gpu::kSgFitComponents; ++c) {
                const std::uint32_t at = gpu::sgFitIndex(lobe, c, texel, texels);
                CHECK_EQ(end.parameters[at], start.parameters[at]);
            }
        }
}

TEST_CASE(
    "direct fit: a poisoned lobe is not hidden by the clamps of its step, and does not spread")
{
    const Fixture f = makeFixture();
    const std::uint32_t texel = 12, lobe = 1, texels = f.problem.texelCount();
    for (const std::uint32_t component :
         {gpu::kSgFitAxis, gpu::kSgFitSharpness, gpu::kSgFitAmplitude + 1}) {
        CAPTURE(component);
        FitState start = f.start;
        start.parameters[gpu::sgFitIndex(lobe, component, texel, texels)] = NAN;
        const FitState end = runFrom(f, start, 5);
        CHECK_GT(end.skippedSteps, 5); // the neighbours' gradients see it, too
        CHECK_EQ(nonFinite(end.parameters), 1);
        CHECK(std::isnan(end.parameters[gpu::sgFitIndex(lobe, component, texel, texels)]));
        CHECK_EQ(nonFinite(end.firstMoments), 0);
        CHECK_EQ(nonFinite(end.secondMoments), 0);
    }
}
