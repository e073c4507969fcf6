// The 26 planes that a network reads: each value where it should be, and in step with the plain
// average of the same samples.
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "passes/hair_blend.hpp"
#include "shaders/shared/hair_masks.h"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

constexpr std::uint32_t kSide = 30; // not a multiple of 8
constexpr std::uint32_t kPadded = 32;
constexpr float kDistance = 100.0f;

Camera camera()
{
    Camera camera;
    camera.eye = {0.0f, 0.0f, kDistance};
    camera.verticalFovDegrees = glm::degrees(2.0f * std::atan(0.5f * float(kSide) / kDistance));
    return camera;
}

// A ribbon ten pixels wide from the lower left to the upper right (y up).
HairStrands diagonal()
{
    HairStrands hair;
    hair.firstPoint = {0, 2};
    hair.points = {{-40.0f, -20.0f, 0.0f}, {40.0f, 20.0f, 0.0f}};
    hair.radii = {5.0f, 5.0f};
    hair.colors = {glm::vec3(0.4f), glm::vec3(0.4f)};
    return hair;
}

struct Input
{
    std::vector<float> planes; // [26, kPadded, kPadded]
    std::vector<glm::vec4> shaded;
    CpuImage average;

    float at(std::uint32_t value, std::uint32_t s, std::uint32_t x, std::uint32_t y) const
    {
        return planes[((4u * value + s) * kPadded + y) * kPadded + x];
    }
};

Input networkInput(float alpha)
{
    Context& context = test::context();
    const HairStrands hair = diagonal();
    HairRenderSettings settings;
    settings.width = settings.height = kSide;
    settings.alpha = alpha;
    settings.shadows = false;
    const std::vector<gpu::HairLight> lights = hairLights(hair, nullptr, settings);
    HairBuffers buffers = uploadHair(context, hair, nullptr, lights, 1);
    HairView view;
    view.viewProjection =
        cameraViewProjection(camera(), kSide, kSide, hairDepthRange(hair, nullptr, camera()));
    view.eye = camera().eye;
    view.width = view.height = kSide;
    view.alpha = alpha;

    RenderGraph graph(context);
    const BufferId shaded = addHairShadingPasses(graph, buffers, lights, {false}, view, settings);
    const HairSampleIds samples =
        addHairStrandsPass(graph, buffers, shaded, view, settings, 1, true, true);
    const HairDepthScale depth{kDistance - 50.0f, 0.01f};
    const ImageId blended =
        addHairBlendPass(graph, buffers, shaded, view, addHairCutsPass(graph, samples));
    const TensorId planes = addHairInputPass(
        graph, samples, blended, depth, createTensor(graph, "planes", hairInputDesc(kSide, kSide)));
    Image hairSum(context, {kSide, kSide, 1, Format::RGBA32F, 1}, "hair sum");
    Image behind(context, {kSide, kSide, 1, Format::RGBA32F, 1}, "behind sum");
    addHairResolvePass(graph, samples, {graph.importImage(hairSum), graph.importImage(behind)},
                       1.0f);
    graph.output(planes.buffer);
    graph.run();
    return {graph.read<float>(planes.buffer), buffers.shaded.downloadAs<glm::vec4>(),
            hairSum.download()};
}

} // namespace

TEST_CASE("hair network input: values of a ribbon and of nothing")
{
    const Input input = networkInput(1.0f);
    REQUIRE(input.planes.size() == std::size_t(gpu::kHairInputPlanes) * kPadded * kPadded);
    const glm::vec4 light = 0.5f * (input.shaded[0] + input.shaded[1]);
    const float brightness = glm::dot(glm::vec3(light), glm::vec3(0.2126f, 0.7152f, 0.0722f));
    for (std::uint32_t s = 0; s < 4; ++s) {
        CAPTURE(s);
        // In the middle; half floats keep 11 bits, the light is that of the strand's middle.
        CHECK(input.at(0, s, 16, 16) == doctest::Approx(std::log1p(brightness)).epsilon(0.02));
        // Interpolation may end just below 1, and storage as a half may truncate: one step.
        CHECK(std::abs(input.at(1, s, 16, 16) - 1.0f) <= 1.0f / 2048.0f);
        CHECK(input.at(2, s, 16, 16) == 0.0f);
        CHECK(input.at(3, s, 16, 16) == doctest::Approx(0.5f).epsilon(2e-3));
        // Up to the right is y down negative: (2, -1) / sqrt 5, of which the double angle has
        // cosine (4 - 1) / 5 and sine 2 * 2 * -1 / 5. The other way round it would have the same.
        CHECK(input.at(4, s, 16, 16) == doctest::Approx(0.6).epsilon(2e-3));
        CHECK(input.at(5, s, 16, 16) == doctest::Approx(-0.8).epsilon(2e-3));
        // In a corner without hair, and past the border right of the ribbon's end.
        for (const glm::uvec2 empty : {glm::uvec2(1, 1), glm::uvec2(31, 8), glm::uvec2(4, 31)}) {
            for (const std::uint32_t value : {0u, 1u, 3u, 4u, 5u})
                CHECK(input.at(value, s, empty.x, empty.y) == 0.0f);
            CHECK(input.at(2, s, empty.x, empty.y) == 1.0f);
            CHECK(input.at(6, 0, empty.x, empty.y) == 1.0f);
        }
    }
    // An opaque strand is blended as one of kHairMostAlpha; sums are halves.
    CHECK(input.at(6, 0, 16, 16) < 2e-6f);
    CHECK(input.at(6, 1, 16, 16) == doctest::Approx(std::log1p(brightness)).epsilon(2e-3));
    CHECK(input.at(6, 1, 1, 1) == 0.0f);
    CHECK(input.at(6, 1, 4, 31) == 0.0f);
}

TEST_CASE("hair network input: the samples are those of the average")
{
    const Input input = networkInput(0.6f);
    bool partial = false;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            float transmittance = 0.0f;
            for (std::uint32_t s = 0; s < 4; ++s)
                transmittance += 0.25f * input.at(2, s, x, y);
            REQUIRE(transmittance == input.average.at(x, y).w); // multiples of 1/4: exact
            partial = partial || (transmittance > 0.0f && transmittance < 1.0f);
        }
    CHECK(partial);
}

TEST_CASE("hair network input: the device's sample masks are those of the C++ twin")
{
    constexpr float kAlpha = 0.6f;
    const Input input = networkInput(kAlpha);
    int checked = 0;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            // Distance from the ribbon's middle, in pixels; its edges are at 5.
            const float right = float(x) + 0.5f - 0.5f * float(kSide);
            const float up = 0.5f * float(kSide) - float(y) - 0.5f;
            if (std::abs(2.0f * up - right) / std::sqrt(5.0f) > 4.0f)
                continue;
            const std::uint32_t mask =
                gpu::hairSampleMask(kAlpha, gpu::hairFragmentBits(0, 0, x, y, 0));
            for (std::uint32_t s = 0; s < 4; ++s)
                REQUIRE(input.at(2, s, x, y) == ((mask >> s & 1u) != 0u ? 0.0f : 1.0f));
            ++checked;
        }
    CHECK(checked > 200);
}

TEST_CASE("hair network input: strands without features are refused")
{
    RenderGraph graph(test::context());
    const ImageId any = graph.createImage("any", {4, 4, 1, Format::R32F, 1});
    const TensorId planes = createTensor(graph, "planes", hairInputDesc(4, 4));
    CHECK_THROWS_AS((void)addHairInputPass(graph, HairSampleIds{}, any, {}, planes), Error);
}
