// The hair passes on the device: hiding, backgrounds, shadows, repeatability, and that a scene
// without hair costs nothing.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "passes/hair_passes.hpp"
#include "tests/gpu/hair_cases.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

TEST_CASE("hair: opaque triangles hide what is behind them")
{
    constexpr std::uint32_t kSide = 64;
    Scene scene; // the left half of the picture, between the first and the second strand
    const float far = 2.0f * float(kSide);
    for (const glm::vec2 p :
         {glm::vec2(-far, -far), glm::vec2(0.0f, -far), glm::vec2(0.0f, far), glm::vec2(-far, far)})
        scene.vertices.push_back({.position = {p, 0.0f}});
    scene.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.triangleMaterials = {0, 0};
    scene.materials.push_back({.name = "wall", .baseColor = {0.2f, 0.4f, 0.6f, 1.0f}});
    HairStrands hair;
    addStrand(hair, {{-30.0f, 10.0f, 4.0f}, {30.0f, 10.0f, 4.0f}}, 4.0f);     // before
    addStrand(hair, {{-30.0f, -10.0f, -4.0f}, {30.0f, -10.0f, -4.0f}}, 4.0f); // behind
    HairRenderSettings settings = plainSettings(kSide);
    settings.exactCoverage = true;
    const HairFrame frame = renderHair(test::context(), hair, &scene, pixelCamera(kSide), settings);
    const auto check = [&](std::uint32_t x, std::uint32_t y, float transmittance) {
        CAPTURE(x);
        CAPTURE(y);
        CHECK(frame.hair.at(x, y).w == transmittance);
        CHECK(frame.exactTransmittance.at(x, y).x == transmittance);
    };
    check(16, 22, 0.0f);
    check(48, 22, 0.0f);
    check(16, 42, 1.0f); // hidden
    check(48, 42, 0.0f);
    // The wall is shaded: bluer than red; the open background keeps its constant colour.
    CHECK(frame.radiance.at(16, 42).z > 2.0f * frame.radiance.at(16, 42).x);
    CHECK(frame.radiance.at(60, 2).x == doctest::Approx(settings.backgroundColor.x).epsilon(1e-3));
}

TEST_CASE("hair: a background picture shows through by the transmittance")
{
    constexpr std::uint32_t kSide = 32;
    const CpuImage background(kSide, kSide, glm::vec4(2.0f, 1.0f, 0.5f, 1.0f));
    HairRenderSettings settings = plainSettings(kSide);
    settings.alpha = 0.5f;
    settings.ambient = glm::vec3(0.0f);
    settings.keyIrradiance = glm::vec3(0.0f); // black hair
    settings.background = &background;
    const HairFrame frame =
        renderHair(test::context(), layers(1, float(kSide)), nullptr, pixelCamera(kSide), settings);
    for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i)
        REQUIRE(frame.radiance.pixels[i].x == frame.hair.pixels[i].w * 2.0f);
}

TEST_CASE("hair: layers and opaque triangles shadow what lies behind them as seen from a light")
{
    // A layer in front of a short strand, then a strand behind a wall; lights far along +z.
    HairStrands hair;
    addStrand(hair, {{-40.0f, 0.0f, 0.0f}, {40.0f, 0.0f, 0.0f}}, 20.0f);
    addStrand(hair, {{-10.0f, 0.0f, -30.0f}, {10.0f, 0.0f, -30.0f}}, 1.0f);
    addStrand(hair, {{30.0f, 36.0f, -30.0f}, {40.0f, 36.0f, -30.0f}}, 1.0f);
    Scene scene;
    for (const glm::vec2 p : {glm::vec2(20.0f, 30.0f), glm::vec2(50.0f, 30.0f),
                              glm::vec2(50.0f, 50.0f), glm::vec2(20.0f, 50.0f)})
        scene.vertices.push_back({.position = {p, -20.0f}});
    for (const glm::vec2 p : {glm::vec2(-30.0f, -8.0f), glm::vec2(-20.0f, -8.0f),
                              glm::vec2(-20.0f, 8.0f)}) // a triangle behind the layer
        scene.vertices.push_back({.position = {p, -25.0f}});
    scene.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
    scene.triangleMaterials = {0, 0, 0};
    scene.materials.push_back({.name = "wall"});
    scene.lights = {{.type = LightType::Directional, .direction = {0.0f, 0.0f, -1.0f}},
                    {.type = LightType::Point, .position = {0.0f, 0.0f, 800.0f}}};
    HairRenderSettings settings = plainSettings(32);
    settings.shadowSize = 128;
    settings.alpha = 0.5f;
    Context& context = test::context();
    for (const std::uint32_t light : {0u, 1u}) {
        const std::vector<gpu::HairLight> all = hairLights(hair, &scene, settings);
        const std::vector<gpu::HairLight> lights = {all[light]};
        REQUIRE(hairLightCastsShadow(hair, lights[0]));
        HairBuffers buffers = uploadHair(context, hair, &scene, lights, 1);
        RenderGraph graph(context);
        HairView view;
        view.eye = {0.0f, 0.0f, 100.0f};
        const BufferId shaded =
            addHairShadingPasses(graph, buffers, lights, {true}, view, settings);
        graph.output(shaded);
        graph.run();
        const std::vector<glm::vec4> values = graph.read<glm::vec4>(shaded);
        REQUIRE(values.size() == 6);
        CAPTURE(light);
        CHECK(values[0].w == 1.0f);
        // 36 samples of 1/2, two in each texel: no more than 4 standard deviations of 0.083.
        CHECK(std::abs(values[2].w - 0.5f) <= 0.34f);
        CHECK(std::abs(values[3].w - 0.5f) <= 0.34f);
        CHECK(values[4].w == 0.0f);
        CHECK(values[5].w == 0.0f);
        const std::vector<glm::vec4> corners = buffers.visibility.downloadAs<glm::vec4>();
        REQUIRE(corners.size() == 9);
        for (std::size_t corner = 0; corner < 6; ++corner)
            CHECK(corners[corner].x == 1.0f); // the wall does not shadow itself
        for (std::size_t corner = 6; corner < 9; ++corner)
            CHECK(std::abs(corners[corner].x - 0.5f) <= 0.15f); // 196 samples: 4 deviations
    }
}

TEST_CASE("hair: the same frame twice is the same bytes, another frame is not")
{
    const HairStrands hair = strandGrid(0.4f);
    HairRenderSettings settings = plainSettings(kGridSide);
    settings.shadows = true;
    settings.shadowSize = 256;
    const auto render = [&] {
        return renderHair(test::context(), hair, nullptr, pixelCamera(kGridSide), settings)
            .radiance;
    };
    const CpuImage first = render();
    const CpuImage second = render();
    REQUIRE(first.pixels.size() == second.pixels.size());
    const std::size_t bytes = first.pixels.size() * sizeof(glm::vec4);
    CHECK(std::memcmp(first.pixels.data(), second.pixels.data(), bytes) == 0);
    settings.frameIndex = 1;
    CHECK(std::memcmp(first.pixels.data(), render().pixels.data(), bytes) != 0);
}

TEST_CASE("hair: without strands there is no pass, no pipeline and no buffer")
{
    Context context = Context::headless({.validation = true});
    const std::uint64_t bytes = context.bytesAllocated(), peak = context.peakBytesAllocated();
    HairRenderSettings settings = plainSettings(16);
    const HairFrame frame = renderHair(context, HairStrands{}, nullptr, pixelCamera(16), settings);
    CHECK(context.pipelinesCreated() == 0);
    CHECK(context.bytesAllocated() == bytes);
    CHECK(context.peakBytesAllocated() == peak);
    CHECK(frame.timings.empty());
    CHECK(frame.drawnSegments == 0);
    REQUIRE(frame.skipped.size() == 1);
    CHECK(frame.skipped[0].find("no strand") != std::string::npos);
    CHECK(frame.radiance.at(3, 3).x == settings.backgroundColor.x);
    CHECK(frame.hair.at(3, 3).w == 1.0f);
}

TEST_CASE("hair: settings out of range are refused with their value")
{
    const HairStrands hair = layers(1, 8.0f);
    HairRenderSettings settings = plainSettings(8);
    settings.alpha = 1.5f;
    CHECK_THROWS_WITH_AS(renderHair(test::context(), hair, nullptr, pixelCamera(8), settings),
                         doctest::Contains("1.5"), Error);
    settings = plainSettings(8);
    settings.width = 0;
    CHECK_THROWS_AS(renderHair(test::context(), hair, nullptr, pixelCamera(8), settings), Error);
}
