// Closed forms: a white furnace, a lit point, an empty sky, a dark room.
#include <doctest/doctest.h>

#include <cmath>

#include "engine/scene/camera.hpp"
#include "engine/scene/environment.hpp"
#include "engine/scene/mesh_builder.hpp"
#include "engine/scene/procedural.hpp"
#include "passes/path_trace.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

struct Moments
{
    glm::dvec3 mean{0.0};
    glm::dvec3 standardError{0.0}; // of the mean
};

// Pixels are independent estimates.
Moments momentsOf(const CpuImage& image)
{
    Moments m;
    const double n = double(image.pixels.size());
    for (const glm::vec4& p : image.pixels)
        m.mean += glm::dvec3(p) / n;
    for (const glm::vec4& p : image.pixels) {
        const glm::dvec3 d = glm::dvec3(p) - m.mean;
        m.standardError += d * d / (n * (n - 1.0));
    }
    m.standardError = glm::sqrt(m.standardError);
    return m;
}

Material lambert(float albedo)
{
    Material material;
    material.baseColor = glm::vec4(albedo, albedo, albedo, 1.0f);
    material.metallic = 0.0f;
    material.specular = 0.0f;
    return material;
}

} // namespace

TEST_CASE("furnace: radiance is 1 / (1 - albedo)")
{
    for (const float albedo : {0.0f, 0.5f, 0.8f}) {
        const Scene scene = buildFurnaceScene(albedo);
        ReferenceSettings settings;
        settings.width = 32;
        settings.height = 24;
        settings.samples = 64;
        settings.bounces = 64; // 0.8^64 = 6e-7 is left out
        TraceStatistics statistics;
        const CpuImage image =
            renderReference(test::context(), scene, defaultCamera(scene), settings, &statistics);
        const Moments m = momentsOf(image);
        const double expected = 1.0 / (1.0 - double(albedo));
        CAPTURE(albedo);
        CAPTURE(m.mean.x);
        CAPTURE(m.standardError.x);
        // Four standard errors: one false alarm in 16,000; 1e-5 for the rounding of long sums.
        CHECK(std::abs(m.mean.x - expected) < 4.0 * m.standardError.x + 1e-5 * expected);
        CHECK(m.standardError.x < 0.02 * expected);
        CHECK(statistics.lostRays == 0);
        CHECK(statistics.rejectedSamples == 0);
    }
}

TEST_CASE("furnace: the same at a millionth and a million times the size")
{
    for (const float scale : {1e-6f, 1e6f}) {
        Scene scene = buildFurnaceScene(0.5f);
        for (Vertex& vertex : scene.vertices)
            vertex.position *= scale;
        Camera camera = defaultCamera(buildFurnaceScene(0.5f));
        camera.eye *= scale;
        camera.target *= scale;
        ReferenceSettings settings;
        settings.width = 16;
        settings.height = 16;
        settings.samples = 64;
        settings.bounces = 32;
        TraceStatistics statistics;
        const Moments m =
            momentsOf(renderReference(test::context(), scene, camera, settings, &statistics));
        CAPTURE(scale);
        CHECK(std::abs(m.mean.x - 2.0) < 4.0 * m.standardError.x + 2e-5);
        CHECK(statistics.rejectedSamples == 0);
    }
}

TEST_CASE("direct light: a square above a floor point, by the form factor")
{
    // A 2 x 2 square, one metre above and facing the point: E = L * 4 * F, F of one quarter, L = 5.
    // Howell. A Catalog of Radiation Heat Transfer Configuration Factors. 2010 (C-11)
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.useMaterial(lambert(0.6f));
    mesh.quad({-0.01f, 0.0f, 0.01f}, {0.02f, 0.0f, 0.0f}, {0.0f, 0.0f, -0.02f});
    Material light = lambert(0.0f);
    light.emissive = glm::vec3(5.0f);
    mesh.useMaterial(light);
    mesh.quad({-1.0f, 1.0f, -1.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f}); // faces down
    const double x = 1.0 / std::sqrt(2.0);
    const double quarter = (x * std::atan(x) + x * std::atan(x)) / (2.0 * 3.141592653589793);
    const double expected = 0.6 * 5.0 * 4.0 * quarter; // albedo / pi * (pi L F)

    Camera camera;
    camera.eye = {0.5f, 0.5f, 0.0f};
    camera.target = {0.0f, 0.0f, 0.0f};
    camera.verticalFovDegrees = 0.5f; // sees only the patch
    ReferenceSettings settings;
    settings.width = 16;
    settings.height = 16;
    settings.samples = 256;
    settings.bounces = 1;
    const Moments m = momentsOf(renderReference(test::context(), scene, camera, settings));
    CAPTURE(m.mean.x);
    CAPTURE(expected);
    // 2e-4: the patch is 1 cm wide, the light is not the same at its border.
    CHECK(std::abs(m.mean.x - expected) < 4.0 * m.standardError.x + 2e-4 * expected);
    CHECK(m.standardError.x < 0.01 * expected);
}

TEST_CASE("environment only: the sky is what the camera sees, exactly")
{
    Scene scene;
    scene.materials.resize(1);
    Environment environment;
    environment.latLong = CpuImage(16, 8);
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 0; x < 16; ++x)
            environment.latLong.at(x, y) = glm::vec4(2.5f, 1.25f, 0.5f, 1.0f);
    scene.environment = environment;
    Camera camera;
    ReferenceSettings settings;
    settings.width = 20;
    settings.height = 10;
    settings.samples = 4;
    const CpuImage image = renderReference(test::context(), scene, camera, settings);
    for (const glm::vec4& p : image.pixels)
        REQUIRE(glm::vec3(p) == glm::vec3(2.5f, 1.25f, 0.5f));
}

TEST_CASE("environment: a Lambert sphere in a constant sky reflects its albedo")
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.useMaterial(lambert(0.7f));
    mesh.quad({-5.0f, 0.0f, 5.0f}, {10.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -10.0f});
    scene.environment = Environment{CpuImage(32, 16, glm::vec4(1.0f))};
    Camera camera;
    camera.eye = {0.0f, 2.0f, 0.1f};
    camera.target = {0.0f, 0.0f, 0.0f};
    ReferenceSettings settings;
    settings.width = 24;
    settings.height = 24;
    settings.samples = 64;
    settings.bounces = 4;
    const Moments m = momentsOf(renderReference(test::context(), scene, camera, settings));
    CHECK(std::abs(m.mean.x - 0.7) < 4.0 * m.standardError.x + 1e-6);
    CHECK(m.standardError.x < 0.005);
}

TEST_CASE("environment: a floor under an uneven sky, by quadrature")
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.useMaterial(lambert(0.5f));
    mesh.quad({-5.0f, 0.0f, 5.0f}, {10.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -10.0f});
    CpuImage sky(64, 32, glm::vec4(0.2f));
    for (std::uint32_t y = 0; y < 32; ++y)
        for (std::uint32_t x = 0; x < 64; ++x)
            sky.at(x, y) += glm::vec4(0.01f * float(x));
    sky.at(13, 6) = glm::vec4(400.0f); // a small sun
    scene.environment = Environment{sky};
    // Irradiance from the upper half, midpoints, 16 x 16 a texel.
    double irradiance = 0.0;
    constexpr int kWidth = 64 * 16;
    constexpr int kHeight = 16 * 16;
    for (int j = 0; j < kHeight; ++j)
        for (int i = 0; i < kWidth; ++i) {
            const double theta = (j + 0.5) / kHeight * 1.5707963267948966;
            const glm::vec3 d = gpu::environmentDirection((float(i) + 0.5f) / kWidth,
                                                          float(theta / 3.141592653589793));
            irradiance += double(environmentRadiance(*scene.environment, d).x) * std::cos(theta) *
                          std::sin(theta) * (1.5707963267948966 / kHeight) *
                          (6.283185307179586 / kWidth);
        }
    const double expected = 0.5 * irradiance / 3.141592653589793;
    Camera camera;
    camera.eye = {0.0f, 2.0f, 0.1f};
    camera.target = {0.0f, 0.0f, 0.0f};
    ReferenceSettings settings;
    settings.width = 24;
    settings.height = 24;
    settings.samples = 64;
    settings.bounces = 1;
    const Moments m = momentsOf(renderReference(test::context(), scene, camera, settings));
    CAPTURE(expected);
    CAPTURE(m.mean.x);
    // 5e-4: midpoint rule on a bilinear sun.
    CHECK(std::abs(m.mean.x - expected) < 4.0 * m.standardError.x + 5e-4 * expected);
    CHECK(m.standardError.x < 0.01 * expected); // without importance sampling it would be 0.03
}

TEST_CASE("punctual light: I cos / d^2 on a Lambert floor")
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.useMaterial(lambert(0.5f));
    mesh.quad({-5.0f, 0.0f, 5.0f}, {10.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -10.0f});
    PunctualLight light;
    light.position = {1.0f, 2.0f, 0.0f};
    light.intensity = glm::vec3(30.0f, 20.0f, 10.0f);
    scene.lights.push_back(light);
    Camera camera;
    camera.eye = {-0.5f, 3.0f, 0.0f};
    camera.target = {0.0f, 0.0f, 0.0f};
    camera.verticalFovDegrees = 0.05f;
    ReferenceSettings settings;
    settings.width = 4;
    settings.height = 4;
    settings.samples = 2;
    const CpuImage image = renderReference(test::context(), scene, camera, settings);
    const double expected = 0.5 / 3.141592653589793 * 30.0 * 2.0 / std::pow(5.0, 1.5);
    // The picture is 3 mm wide, the light differs by 0.1 % over it.
    CHECK(double(image.at(2, 2).x) == doctest::Approx(expected).epsilon(0.002));
    CHECK(double(image.at(2, 2).z) == doctest::Approx(expected / 3.0).epsilon(0.002));
}

TEST_CASE("no light: black, and nothing is created for light")
{
    const Scene scene = buildDarkBoxScene();
    GpuScene device = uploadScene(test::context(), scene);
    CHECK_FALSE(device.has(gpu::kFeatureEmitters));
    CHECK_FALSE(device.environment.valid());
    CHECK_FALSE(device.lights.valid());
    CHECK_FALSE(device.textures.valid());
    CHECK(device.bufferCount() == 5);
    ReferenceSettings settings;
    settings.width = 16;
    settings.height = 16;
    settings.samples = 4;
    const CpuImage image = renderReference(test::context(), device, defaultCamera(scene), settings);
    for (const glm::vec4& p : image.pixels)
        REQUIRE(glm::vec3(p) == glm::vec3(0.0f));
}

TEST_CASE("nothing at all: an empty scene renders black")
{
    Scene scene;
    scene.materials.resize(1);
    ReferenceSettings settings;
    settings.width = 5;
    settings.height = 3;
    settings.samples = 1;
    const CpuImage image = renderReference(test::context(), scene, Camera{}, settings);
    for (const glm::vec4& p : image.pixels)
        REQUIRE(glm::vec3(p) == glm::vec3(0.0f));
}
