// Light field images with known content; slicing and resuming must not show.
#include <doctest/doctest.h>

#include <cmath>

#include "engine/base/error.hpp"
#include "engine/scene/mesh_builder.hpp"
#include "engine/scene/procedural.hpp"
#include "passes/lightfield_capture.hpp"
#include "shaders/shared/octahedral.h"
#include "shaders/shared/rgb9e5.h"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

Material lambert(float albedo, float emission)
{
    Material material;
    material.baseColor = glm::vec4(albedo, albedo, albedo, 1.0f);
    material.metallic = 0.0f;
    material.specular = 0.0f;
    material.emissive = glm::vec3(emission);
    return material;
}

gpu::CapturePoint floorPoint(glm::vec3 position)
{
    gpu::CapturePoint point{};
    point.position = position;
    point.tangent = {1, 0, 0};
    point.normal = {0, 1, 0};
    point.geometric = {0, 1, 0};
    return point;
}

CpuLightfield captureAll(LightfieldCapture& capture)
{
    while (!capture.step()) {
    }
    return downloadLightfield(capture.finish());
}

CpuLightfield captureScene(const Scene& scene, std::vector<gpu::CapturePoint> points,
                           const CaptureSettings& settings)
{
    GpuScene device = uploadScene(test::context(), scene);
    LightfieldCapture capture(test::context(), device, std::move(points), settings);
    return captureAll(capture);
}

} // namespace

TEST_CASE("capture: every direction of a furnace brings 1 / (1 - albedo)")
{
    const Scene scene = buildFurnaceScene(0.5f);
    const Atlas atlas = buildAtlas(scene, {16, 2});
    GpuScene device = uploadScene(test::context(), scene);
    CaptureSettings settings;
    settings.size = 8;
    settings.samplesPerDirection = 16;
    settings.bounces = 24;
    TraceStatistics statistics;
    const Lightfield field =
        captureLightfield(test::context(), scene, device, atlas, settings, &statistics);
    REQUIRE(field.texelCount == atlas.texels.size());
    CHECK_FALSE(field.hasEnvironment);
    CHECK(field.clampedCells == 0);
    CHECK(statistics.lostRays == 0);
    for (const std::uint8_t valid : field.valid)
        REQUIRE(valid == 1);
    const CpuLightfield cpu = downloadLightfield(field);
    double mean = 0.0, squares = 0.0;
    for (const std::uint32_t word : cpu.radiance) {
        const double value = double(gpu::unpackRgb9e5(word).x);
        mean += value / double(cpu.radiance.size());
        squares += value * value / double(cpu.radiance.size());
    }
    const double error = std::sqrt((squares - mean * mean) / double(cpu.radiance.size()));
    // Four standard errors, and 1/1022 for the packing.
    CHECK(std::abs(mean - 2.0) < 4.0 * error + 0.002);
}

TEST_CASE("capture: a window of light lies where it should, the sky in its own image")
{
    // A black floor under a black ceiling plate with light 3 on its underside; sky 0.5 around.
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.useMaterial(lambert(0.0f, 3.0f));
    mesh.quad({0.0f, 1.0f, -2.0f}, {3.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 3.0f}); // faces down
    scene.environment = Environment{CpuImage(16, 8, glm::vec4(0.5f))};
    CaptureSettings settings;
    settings.samplesPerDirection = 64;
    const glm::vec3 eye(0.2f, 0.0f, 0.1f);
    const CpuLightfield field = captureScene(scene, {floorPoint(eye)}, settings);
    REQUIRE(field.environment.size() == 256);
    int mixed = 0;
    for (std::uint32_t cell = 0; cell < 256; ++cell) {
        // Is the cell inside, outside or across the border of the plate? Image axes: x = +x, y = N
        // x T = -z.
        int hits = 0;
        for (int k = 0; k < 64; ++k) {
            const glm::vec2 uv = (glm::vec2(cell % 16, cell / 16) +
                                  glm::vec2(float(k % 8) / 7.0f, float(k / 8) / 7.0f)) /
                                 16.0f;
            const glm::vec3 d = gpu::hemiOctDecode(glm::clamp(uv, 1e-4f, 1.0f - 1e-4f));
            const glm::vec3 world(d.x, d.z, -d.y);
            const glm::vec3 p = eye + world / world.y;
            hits +=
                world.y > 1e-4f && p.x > 0.0f && p.x < 3.0f && p.z > -2.0f && p.z < 1.0f ? 1 : 0;
        }
        const float light = field.radianceAt(0, cell).x;
        const float sky = field.environmentAt(0, cell).x;
        if (hits == 64) {
            REQUIRE(light == doctest::Approx(3.0f).epsilon(0.003));
            REQUIRE(sky == 0.0f);
        } else if (hits == 0) {
            REQUIRE(light == 0.0f);
            REQUIRE(sky == 0.5f);
        } else {
            ++mixed;
            // Stratified 64 samples know a covered fraction to about 1/16.
            REQUIRE(std::abs(light / 3.0f - float(hits) / 64.0f) < 0.15f);
            REQUIRE(std::abs(light / 3.0f + sky / 0.5f - 1.0f) < 0.005f);
        }
    }
    CHECK(mixed > 8);
}

TEST_CASE("capture: points inside closed geometry are not valid")
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.useMaterial(lambert(0.5f, 0.0f));
    mesh.box({-1, -1, -1}, {1, 1, 1});
    scene.environment = Environment{CpuImage(16, 8, glm::vec4(0.5f))};
    CaptureSettings settings;
    settings.size = 4;
    const CpuLightfield field =
        captureScene(scene, {floorPoint({0, 0, 0}), floorPoint({0, 3, 0})}, settings);
    CHECK(field.valid[0] == 0);
    CHECK(field.valid[1] == 1);
}

TEST_CASE("capture: the same bytes whole, in other slices, and resumed in a new capture")
{
    const Scene scene = buildRoomScene();
    GpuScene device = uploadScene(test::context(), scene);
    std::vector<gpu::CapturePoint> points;
    for (int i = 0; i < 80; ++i)
        points.push_back(floorPoint({-1.0f + 0.02f * float(i), 0.5f, -1.0f + 0.015f * float(i)}));
    CaptureSettings settings;
    settings.size = 32; // 64 texels a slice: two slices
    settings.samplesPerDirection = 1;
    settings.bounces = 2;
    LightfieldCapture whole(test::context(), device, points, settings);
    const CpuLightfield expected = captureAll(whole);

    settings.cellsPerDispatch = 20000;
    LightfieldCapture interrupted(test::context(), device, points, settings);
    CHECK_FALSE(interrupted.step());
    CHECK(interrupted.completedTexels() == 64);
    const std::vector<std::uint8_t> saved = interrupted.save();
    LightfieldCapture resumed(test::context(), device, points, settings);
    resumed.restore(saved);
    CHECK(resumed.completedTexels() == 64);
    const CpuLightfield again = captureAll(resumed);
    CHECK(again.radiance == expected.radiance);
    CHECK(again.valid == expected.valid);

    // Bytes that do not belong here are refused.
    settings.seed = 9;
    LightfieldCapture other(test::context(), device, points, settings);
    CHECK_THROWS_AS(other.restore(saved), FileError);
    std::vector<std::uint8_t> broken = saved;
    broken.resize(broken.size() / 2);
    settings.seed = 1;
    LightfieldCapture third(test::context(), device, points, settings);
    CHECK_THROWS_AS(third.restore(broken), FileError);
    CHECK_THROWS_AS(third.restore({}), FileError);
}
