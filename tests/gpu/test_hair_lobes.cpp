// Distant lobes on the device: as the shared functions say, shadowed, and white in a white furnace.
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "passes/hair_lobe_passes.hpp"
#include "shaders/shared/hair_lobe.h"
#include "shaders/shared/rng.h"
#include "tests/gpu/hair_cases.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

gpu::HairLobe lobe(glm::vec3 axis, float sharpness, glm::vec3 energy, float share)
{
    gpu::HairLobe result{};
    result.axis = glm::normalize(axis);
    result.sharpness = sharpness;
    result.energy = energy;
    result.share = share;
    return result;
}

std::vector<glm::vec4> shade(const HairStrands& hair, const HairDistantLight& light,
                             const HairRenderSettings& settings, glm::vec3 eye,
                             const Scene* opaque = nullptr)
{
    HairBuffers buffers = uploadHair(test::context(), hair, opaque, {}, 1);
    uploadHairLobes(test::context(), buffers, hair, opaque, light, settings);
    RenderGraph graph(test::context());
    HairView view;
    view.eye = eye;
    const BufferId shaded = addHairLobePasses(graph, buffers, graph.importBuffer(buffers.shaded),
                                              true, light, view, settings);
    graph.output(shaded);
    graph.run();
    return graph.read<glm::vec4>(shaded);
}

// A ball of strands in all directions, as dense as hair.
HairStrands tangle(glm::vec3 color)
{
    HairStrands hair;
    for (std::uint32_t i = 0; i < 600; ++i) {
        const glm::vec3 a = gpu::uniform3(i, 0u, 0u, 9u) - 0.5f;
        const glm::vec3 b = gpu::uniform3(i, 1u, 0u, 9u) - 0.5f;
        addStrand(hair, {50.0f * a, 25.0f * (a + b), 50.0f * b}, 0.5f);
    }
    std::fill(hair.colors.begin(), hair.colors.end(), color);
    return hair;
}

} // namespace

TEST_CASE("hair: the kernel's lobes are the shared functions'")
{
    HairStrands hair = tangle(glm::vec3(0.5f, 0.3f, 0.15f));
    HairDistantLight light;
    light.lobes = {lobe({0.3f, 0.8f, -0.2f}, 60.0f, glm::vec3(3.0f, 2.0f, 1.0f), 0.6f),
                   lobe({-1.0f, 0.2f, 0.1f}, 3.0f, glm::vec3(1.0f), 0.3f),
                   lobe({0.0f, 1.0f, 0.0f}, 0.0f, glm::vec3(0.4f), 0.1f)};
    const glm::vec3 eye(0.0f, 10.0f, 200.0f);
    const HairRenderSettings settings = plainSettings(32); // no shadows
    const std::vector<glm::vec4> values = shade(hair, light, settings, eye);
    const std::vector<glm::vec3> tangents = hairTangents(hair);
    REQUIRE(values.size() == hair.points.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        glm::vec3 expected(0.0f);
        for (const gpu::HairLobe& l : light.lobes)
            expected += l.energy * gpu::hairScatterLobe(tangents[i], l.axis, l.sharpness,
                                                        glm::normalize(eye - hair.points[i]),
                                                        hair.colors[i], settings.roughness,
                                                        glm::radians(settings.tiltDegrees));
        for (int c = 0; c < 3; ++c) // the device's exp and log
            REQUIRE(values[i][c] == doctest::Approx(expected[c]).epsilon(2e-3));
        REQUIRE(values[i].w == doctest::Approx(1.0).epsilon(1e-5));
    }
}

TEST_CASE("hair: a head of white hair stays white in a white furnace, a dark one darkens inside")
{
    HairDistantLight light;
    const float all = 4.0f * 3.14159265f;
    light.lobes = {lobe({0.0f, 1.0f, 0.0f}, 0.0f, glm::vec3(all), 1.0f)};
    HairRenderSettings settings = plainSettings(32);
    settings.shadows = true;
    const auto check = [&](float color, auto&& verdict) {
        HairStrands hair = tangle(glm::vec3(color));
        const std::vector<glm::vec4> values = shade(hair, light, settings, {0.0f, 0.0f, 300.0f});
        float least = 1.0f;
        for (std::size_t i = 0; i < values.size(); ++i) {
            verdict(values[i]);
            least = std::min(least, values[i].w);
        }
        CHECK(least < 0.2f); // there is an inside
    };
    check(1.0f, [](const glm::vec4& value) {
        REQUIRE(value.x <= 1.005f);
        REQUIRE((value.x >= 0.9f || value.w == 0.0f)); // unless no light comes in at all
    });
    // At grazing angles the surface reflects most, whatever the pigment: never more than arrives.
    check(0.2f, [](const glm::vec4& value) { REQUIRE(value.x <= 0.9f * value.w + 1e-4f); });
}

TEST_CASE("hair: a narrow lobe is shadowed along its axis, a wide one by the mean")
{
    // A layer in front (+z) of a short strand.
    HairStrands hair;
    addStrand(hair, {{-40.0f, 0.0f, 0.0f}, {40.0f, 0.0f, 0.0f}}, 20.0f);
    addStrand(hair, {{-10.0f, 0.0f, -20.0f}, {10.0f, 0.0f, -20.0f}}, 1.0f);
    HairRenderSettings settings = plainSettings(32);
    settings.shadows = true;
    settings.shadowSize = 128;
    HairDistantLight light;
    const auto visible = [&](glm::vec3 axis, float sharpness, std::uint32_t mapped) {
        light.lobes = {lobe(axis, sharpness, glm::vec3(1.0f), 1.0f)};
        light.mapped = mapped;
        return shade(hair, light, settings, {0.0f, 0.0f, 200.0f})[2].w;
    };
    CHECK(visible({0.0f, 0.0f, 1.0f}, 100.0f, 1) == 0.0f);
    CHECK(visible({0.0f, 0.0f, -1.0f}, 100.0f, 1) == 1.0f);
    const float front = visible({0.0f, 0.0f, 1.0f}, 2.0f, 0);
    const float mean = visible({0.0f, 0.0f, 1.0f}, 0.0f, 0);
    const float back = visible({0.0f, 0.0f, -1.0f}, 2.0f, 0);
    CHECK(mean == doctest::Approx(0.5).epsilon(0.01)); // 4 of 8 directions
    CHECK(front < 0.3f);
    CHECK(back > 0.7f);
}

TEST_CASE("hair: a closed room hides the sky, but not the light field that it has made itself")
{
    HairStrands hair;
    addStrand(hair, {{-10.0f, 0.0f, 0.0f}, {10.0f, 0.0f, 0.0f}}, 0.1f);
    Scene room; // a wall far to the right of the strand and one within its bounds to the left
    for (const float x : {300.0f, -5.0f})
        for (const glm::vec2 p : {glm::vec2(-400.0f, -400.0f), glm::vec2(400.0f, -400.0f),
                                  glm::vec2(400.0f, 400.0f), glm::vec2(-400.0f, 400.0f)})
            room.vertices.push_back({.position = {x, p}});
    room.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    room.triangleMaterials = {0, 0, 0, 0};
    room.materials.push_back({.name = "wall"});
    HairRenderSettings settings = plainSettings(32);
    settings.shadows = true;
    settings.shadowSize = 64;
    const auto visible = [&](float towards, bool local) {
        HairDistantLight light;
        light.lobes = {lobe({towards, 0.3f, 0.0f}, 100.0f, glm::vec3(1.0f), 1.0f)};
        light.mapped = 1;
        light.local = local;
        return shade(hair, light, settings, {0.0f, 0.0f, 200.0f}, &room)[1].w;
    };
    CHECK(visible(1.0f, false) == 0.0f);
    CHECK(visible(1.0f, true) == 1.0f);
    CHECK(visible(-1.0f, true) == 0.0f); // what stands among the hair does
}
