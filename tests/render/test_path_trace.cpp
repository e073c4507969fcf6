// The kernel against its CPU twin, against itself under other slicings, and against Blender Cycles.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "engine/base/image_io.hpp"
#include "engine/scene/camera.hpp"
#include "engine/scene/mesh_builder.hpp"
#include "engine/scene/procedural.hpp"
#include "engine/scene/scene_loader.hpp"
#include "passes/cpu_tracer.hpp"
#include "passes/path_trace.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

Texture checker(glm::u8vec4 a, glm::u8vec4 b)
{
    Texture texture;
    texture.width = 4;
    texture.height = 4;
    for (int i = 0; i < 16; ++i) {
        const glm::u8vec4 c = (i + i / 4) % 2 == 0 ? a : b;
        texture.rgba.insert(texture.rgba.end(), {c.x, c.y, c.z, c.w});
    }
    return texture;
}

Material plain(glm::vec3 color, float roughness, float metallic)
{
    Material material;
    material.baseColor = glm::vec4(color, 1.0f);
    material.roughness = roughness;
    material.metallic = metallic;
    return material;
}

// Every branch of the tracer: layers, textures of all kinds, a mask, all light types, an
// environment.
Scene everythingScene()
{
    Scene scene;
    scene.textures.push_back(checker({255, 255, 255, 255}, {60, 120, 200, 0}));
    scene.textures.push_back(checker({128, 128, 255, 255}, {160, 110, 240, 255}));
    MeshBuilder mesh(scene);
    Material floor = plain({0.8f, 0.7f, 0.6f}, 0.6f, 0.0f);
    floor.normalTexture.texture = 1;
    floor.metallicRoughnessTexture.texture = 1;
    mesh.useMaterial(floor);
    mesh.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    mesh.useMaterial(plain({0.9f, 0.6f, 0.3f}, 0.3f, 1.0f));
    mesh.sphere({0.7f, 0.5f, 0.0f}, 0.5f, 2);
    Material fence = plain({1, 1, 1}, 0.9f, 0.0f);
    fence.baseColorTexture.texture = 0;
    fence.alphaCutoff = 0.5f;
    fence.doubleSided = true;
    mesh.useMaterial(fence);
    mesh.quad({-1.5f, 0.0f, 0.3f}, {1.2f, 0, 0}, {0, 1.2f, 0});
    Material lamp = plain({0.2f, 0.2f, 0.2f}, 1.0f, 0.0f);
    lamp.emissive = glm::vec3(6.0f, 5.0f, 4.0f);
    lamp.emissiveTexture.texture = 0;
    mesh.useMaterial(lamp);
    mesh.quad({-0.5f, 2.0f, -0.5f}, {1, 0, 0}, {0, 0, 1}); // faces down
    PunctualLight spot;
    spot.type = LightType::Spot;
    spot.position = {1.5f, 2.0f, 1.0f};
    spot.direction = glm::normalize(glm::vec3(-1.0f, -2.0f, -1.0f));
    spot.intensity = glm::vec3(4.0f);
    spot.innerConeCos = 0.95f;
    scene.lights.push_back(spot);
    PunctualLight sun;
    sun.type = LightType::Directional;
    sun.direction = glm::normalize(glm::vec3(0.3f, -1.0f, 0.2f));
    sun.intensity = glm::vec3(0.5f);
    scene.lights.push_back(sun);
    PunctualLight point;
    point.position = {-1.0f, 1.0f, 1.0f};
    point.range = 4.0f;
    scene.lights.push_back(point);
    CpuImage sky(32, 16, glm::vec4(0.3f, 0.4f, 0.6f, 1.0f));
    sky.at(20, 3) = glm::vec4(60.0f, 50.0f, 40.0f, 1.0f);
    scene.environment = Environment{sky};
    return scene;
}

Camera viewOf(glm::vec3 eye, glm::vec3 target)
{
    Camera camera;
    camera.eye = eye;
    camera.target = target;
    return camera;
}

ReferenceSettings tiny(std::uint32_t samples)
{
    ReferenceSettings settings;
    settings.width = 24;
    settings.height = 18;
    settings.samples = samples;
    settings.bounces = 5;
    return settings;
}

// The same random numbers: pixels agree but for paths that rounding sends another way.
void compareWithTwin(const Scene& scene, const Camera& camera, double allowedOutliers)
{
    const ReferenceSettings settings = tiny(4);
    TraceStatistics statistics;
    const CpuImage device = renderReference(test::context(), scene, camera, settings, &statistics);
    const CpuImage twin = renderOnCpu(scene, camera, settings);
    std::size_t outliers = 0;
    glm::dvec3 sumDevice(0.0), sumTwin(0.0);
    for (std::size_t i = 0; i < twin.pixels.size(); ++i) {
        const glm::vec3 a(device.pixels[i]), b(twin.pixels[i]);
        sumDevice += glm::dvec3(a);
        sumTwin += glm::dvec3(b);
        const float bound = 2e-3f * (0.05f + std::max({b.x, b.y, b.z}));
        const glm::vec3 d = glm::abs(a - b);
        outliers += std::max({d.x, d.y, d.z}) > bound ? 1 : 0;
    }
    CAPTURE(outliers);
    CHECK(double(outliers) <= allowedOutliers * double(twin.pixels.size()));
    CHECK(sumTwin.x > 1.0);
    // Other paths of the same distribution: the picture's sum moves little.
    for (int k = 0; k < 3; ++k)
        CHECK(sumDevice[k] == doctest::Approx(sumTwin[k]).epsilon(0.03));
    CHECK(statistics.lostRays == 0);
    CHECK(statistics.rejectedSamples == 0);
}

} // namespace

TEST_CASE("path trace: agrees with the CPU twin, pixel by pixel")
{
    const Scene room = buildRoomScene();
    compareWithTwin(room, defaultCamera(room), 0.03);
    // Masks, mirror-like highlights and texture borders amplify rounding more often.
    compareWithTwin(everythingScene(), viewOf({0.5f, 1.2f, 2.6f}, {0, 0.4f, 0}), 0.06);
}

TEST_CASE("path trace: bitwise the same however it is sliced, and when repeated")
{
    const Scene scene = everythingScene();
    const Camera camera = viewOf({0.5f, 1.2f, 2.6f}, {0, 0.4f, 0});
    GpuScene device = uploadScene(test::context(), scene);
    ReferenceSettings settings = tiny(3);
    const CpuImage first = renderReference(test::context(), device, camera, settings);
    for (const std::uint32_t pixels : {32u, 100u, 432u}) {
        settings.pixelsPerDispatch = pixels;
        const CpuImage again = renderReference(test::context(), device, camera, settings);
        CHECK(again.pixels == first.pixels);
    }
    settings.seed = 2;
    CHECK(renderReference(test::context(), device, camera, settings).pixels != first.pixels);
}

TEST_CASE("path trace: more samples than one share of the trip budget")
{
    // A dispatch stops starting paths at its budget; the sums must not notice.
    const Scene scene = buildFurnaceScene(0.8f);
    ReferenceSettings settings;
    settings.width = 8;
    settings.height = 4;
    settings.samples = 600;
    settings.bounces = 64;
    TraceStatistics statistics;
    const CpuImage image =
        renderReference(test::context(), scene, defaultCamera(scene), settings, &statistics);
    CHECK(statistics.dispatches >= 3);
    double mean = 0.0;
    for (const glm::vec4& p : image.pixels)
        mean += double(p.x) / double(image.pixels.size());
    // sd of a path is about 4.5; 19200 paths give 0.03.
    CHECK(std::abs(mean - 5.0) < 0.13);
}

TEST_CASE("path trace: emission of a single-sided surface shows on its front only")
{
    for (const bool doubleSided : {false, true}) {
        Scene scene;
        MeshBuilder mesh(scene);
        Material lamp = plain(glm::vec3(0.0f), 1.0f, 0.0f);
        lamp.specular = 0.0f;
        lamp.emissive = glm::vec3(2.0f);
        lamp.doubleSided = doubleSided;
        mesh.useMaterial(lamp);
        mesh.quad({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}); // faces +z
        const ReferenceSettings settings = tiny(1);
        const auto centre = [&](float z) {
            return renderReference(test::context(), scene, viewOf({0, 0, z}, {0, 0, 0}), settings)
                .at(12, 9)
                .x;
        };
        CHECK(centre(1.0f) == 2.0f);
        CHECK(centre(-1.0f) == (doubleSided ? 2.0f : 0.0f));
    }
}

TEST_CASE("path trace: Cornell box against Blender Cycles, 7000 samples")
{
    const std::string folder = test::dataFolder();
    if (folder.empty() ||
        !std::filesystem::exists(folder + "/reference/cornell_lambert_cycles.exr")) {
        MESSAGE("skipped: no data folder");
        return;
    }
    const Scene scene = loadScene(folder + "/scenes/cornell_lambert.gltf");
    const CpuImage truth = loadImage(folder + "/reference/cornell_lambert_cycles.exr");
    ReferenceSettings settings;
    settings.width = truth.width;
    settings.height = truth.height;
    settings.samples = 16;
    TraceStatistics statistics;
    const CpuImage image =
        renderReference(test::context(), scene, defaultCamera(scene), settings, &statistics);
    glm::dvec3 mean(0.0), expected(0.0), squares(0.0);
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        mean += glm::dvec3(image.pixels[i]) / double(truth.pixels.size());
        expected += glm::dvec3(truth.pixels[i]) / double(truth.pixels.size());
    }
    int blocks = 0;
    for (std::uint32_t y = 0; y < truth.height; y += 8)
        for (std::uint32_t x = 0; x < truth.width; x += 8) {
            glm::dvec3 d(0.0);
            for (std::uint32_t k = 0; k < 64; ++k)
                d += glm::dvec3(image.at(x + k % 8, y + k / 8) - truth.at(x + k % 8, y + k / 8));
            squares += d * d / 4096.0;
            ++blocks;
        }
    for (int k = 0; k < 3; ++k) {
        const double rmse = std::sqrt(squares[k] / blocks) / expected[k];
        CAPTURE(k);
        CAPTURE(mean[k] / expected[k]);
        CAPTURE(rmse);
        // The goals at 1024 samples are 1 % and 2 %; 0.1 % and 1.3 % were measured. 16 samples
        // have 8 times that noise; their mean over 1200 blocks moves by 0.3 %.
        CHECK(std::abs(mean[k] / expected[k] - 1.0) < 0.015);
        CHECK(rmse < 0.14);
    }
    CHECK(statistics.lostRays == 0);
}
