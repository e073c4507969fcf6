// Shading from lobes whose answer is known in closed form.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/scene/environment.hpp"
#include "passes/downsample.hpp"
#include "passes/render_frame.hpp"
#include "passes/specular_lut.hpp"
#include "passes/tonemap.hpp"
#include "shaders/shared/brdf.h"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

// A square of 2 m around the origin, facing +z, seen from +z: fills the picture.
Scene buildSquare(const Material& material)
{
    Scene scene;
    scene.name = "square";
    for (const glm::vec2 p :
         {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
        Vertex vertex;
        vertex.position = glm::vec3(p, 0.0f);
        vertex.uv0 = vertex.uv1 = 0.5f + 0.5f * p;
        scene.vertices.push_back(vertex);
    }
    scene.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.triangleMaterials = {0, 0};
    scene.materials = {material};
    return scene;
}

Material lambert(glm::vec3 albedo)
{
    Material material;
    material.baseColor = glm::vec4(albedo, 1.0f);
    material.metallic = 0.0f;
    material.specular = 0.0f;
    return material;
}

Material metal(glm::vec3 color, float roughness)
{
    Material material;
    material.baseColor = glm::vec4(color, 1.0f);
    material.roughness = roughness;
    return material;
}

// The frame of the square's atlas: T along growing u.
glm::vec3 toSquareFrame(const Atlas& atlas, glm::vec3 direction)
{
    const glm::vec3 n(0.0f, 0.0f, 1.0f);
    const glm::vec3 t = atlas.corners[0].tangent;
    return {glm::dot(t, direction), glm::dot(glm::cross(n, t), direction), direction.z};
}

SgField uniformField(const Atlas& atlas, const SgLobe& lobe)
{
    SgField field;
    field.lobeCount = 1;
    field.lobes.assign(atlas.texels.size(), lobe);
    return field;
}

// Every texel holds this one lobe, its axis given in world space.
SgBake bakeOf(const Scene& scene, glm::vec3 axis, float lambda, glm::vec3 amplitude)
{
    SgBake bake;
    bake.atlas = buildAtlas(scene, {.resolution = 32});
    bake.radiance =
        uniformField(bake.atlas, {toSquareFrame(bake.atlas, axis), std::log(lambda), amplitude});
    return bake;
}

const glm::vec3 kUp(0.0f, 0.0f, 1.0f);

Camera cameraAt(float degrees)
{
    const float a = glm::radians(degrees);
    return {.eye = 2.0f * glm::vec3(std::sin(a), 0.0f, std::cos(a)),
            .target = glm::vec3(0.0f),
            .verticalFovDegrees = 5.0f};
}

FrameResult render(const Scene& scene, const SgBake& bake, const Camera& camera,
                   RenderSettings settings = {})
{
    settings.width = 16;
    settings.height = 16;
    GpuScene device = uploadScene(test::context(), scene);
    return renderFrame(test::context(), scene, device, bake, camera, settings);
}

glm::vec3 centre(const FrameResult& frame)
{
    return glm::vec3(frame.radiance.at(8, 8));
}

void checkClose(glm::vec3 actual, glm::vec3 expected, double relative)
{
    for (int c = 0; c < 3; ++c)
        CHECK(actual[c] == doctest::Approx(expected[c]).epsilon(relative));
}

} // namespace

TEST_CASE("shade: constant light of 1 on albedo rho gives rho, on every pixel")
{
    const glm::vec3 rho(0.2f, 0.5f, 0.8f);
    const Scene scene = buildSquare(lambert(rho));
    // Sharpness 1e-4 is constant to 2e-4 over the sphere.
    const FrameResult frame =
        render(scene, bakeOf(scene, kUp, 1e-4f, glm::vec3(1.0f)), cameraAt(30.0f));
    for (const glm::vec4& pixel : frame.radiance.pixels)
        checkClose(glm::vec3(pixel), rho, 1e-3);
}

TEST_CASE("shade: emission adds to reflection as in a furnace")
{
    Material material = lambert(glm::vec3(0.5f));
    material.emissive = glm::vec3(1.0f);
    const Scene scene = buildSquare(material);
    // Inside a furnace all surroundings have radiance 1 / (1 - rho) = 2.
    const FrameResult frame =
        render(scene, bakeOf(scene, kUp, 1e-4f, glm::vec3(2.0f)), cameraAt(0.0f));
    checkClose(centre(frame), glm::vec3(2.0f), 1e-3);
}

TEST_CASE("shade: one sharp lobe is a directional light")
{
    const glm::vec3 light = glm::normalize(glm::vec3(-0.5f, 0.3f, 0.7f));
    constexpr float kLambda = 2e4f;
    const float irradiance = 3.0f; // perpendicular
    const glm::vec3 amplitude(irradiance * kLambda / (2.0f * gpu::kPi));
    SUBCASE("on Lambert")
    {
        const Scene scene = buildSquare(lambert(glm::vec3(0.6f)));
        const FrameResult frame =
            render(scene, bakeOf(scene, light, kLambda, amplitude), cameraAt(20.0f));
        // Halves: ln(lambda) = 9.9 is off by up to 0.004, lambda and so the energy by 0.4 %; the
        // axis by 5e-4.
        checkClose(centre(frame), glm::vec3(0.6f / gpu::kPi * irradiance * light.z), 6e-3);
    }
    SUBCASE("on a rough metal, seen near the mirror direction")
    {
        const glm::vec3 color(0.9f, 0.6f, 0.3f);
        for (const float roughness : {0.5f, 0.8f}) {
            const Scene scene = buildSquare(metal(color, roughness));
            const Camera camera = cameraAt(30.0f);
            const FrameResult frame =
                render(scene, bakeOf(scene, light, kLambda, amplitude), camera);
            const gpu::Surface surface =
                gpu::makeSurface(color, 1.0f, roughness, 1.0f, glm::vec3(1.0f));
            const glm::vec3 exact =
                gpu::evaluateBrdf(surface, glm::normalize(camera.eye), light).value * irradiance;
            CAPTURE(roughness);
            // A point light asks for the BRDF itself; four lobes follow it to 12 %
            // (tests/unit/test_sg_specular.cpp).
            checkClose(centre(frame), exact, 0.15);
        }
    }
}

TEST_CASE("shade: the BRDF of the path tracer under even light")
{
    // Plastic: what is reflected by layer and base together, against quadrature over the tracer's
    // own BRDF.
    Material material;
    material.baseColor = glm::vec4(0.7f, 0.4f, 0.1f, 1.0f);
    material.metallic = 0.0f;
    for (const float roughness : {0.3f, 0.7f})
        for (const float degrees : {10.0f, 60.0f}) {
            material.roughness = roughness;
            const Scene scene = buildSquare(material);
            const Camera camera = cameraAt(degrees);
            const FrameResult frame =
                render(scene, bakeOf(scene, kUp, 1e-4f, glm::vec3(1.0f)), camera);
            const gpu::Surface surface = gpu::makeSurface(glm::vec3(material.baseColor), 0.0f,
                                                          roughness, 1.0f, glm::vec3(1.0f));
            const glm::vec3 view = glm::normalize(camera.eye);
            glm::dvec3 sum(0.0);
            constexpr int kSamples = 20000;
            for (int i = 0; i < kSamples; ++i) {
                const gpu::vec3 u((float(i) + 0.5f) / kSamples,
                                  std::fmod(float(i) * 0.618034f, 1.0f),
                                  std::fmod(float(i) * 0.754878f, 1.0f));
                const gpu::vec3 light = gpu::sampleBrdf(surface, view, u);
                const gpu::BrdfValue brdf = gpu::evaluateBrdf(surface, view, light);
                if (brdf.pdf > 0.0f)
                    sum += glm::dvec3(brdf.value / brdf.pdf);
            }
            CAPTURE(roughness);
            CAPTURE(degrees);
            checkClose(centre(frame), glm::vec3(sum / double(kSamples)), 0.03);
        }
}

TEST_CASE("shade: only what the scene needs runs")
{
    using Names = std::vector<std::string>;
    const SgBake plain = bakeOf(buildSquare(lambert(glm::vec3(0.5f))), kUp, 1.0f, glm::vec3(1.0f));
    SUBCASE("Lambert, no environment, no lights")
    {
        const FrameResult frame =
            render(buildSquare(lambert(glm::vec3(0.5f))), plain, cameraAt(0.0f));
        CHECK(frame.passes == Names{"visibility", "surfaces", "sg diffuse", "downsample"});
        CHECK(frame.skipped.size() == 3);
    }
    SUBCASE("no supersampling, no downsampling")
    {
        const FrameResult frame = render(buildSquare(lambert(glm::vec3(0.5f))), plain,
                                         cameraAt(0.0f), {.supersample = 1});
        CHECK(frame.passes == Names{"visibility", "surfaces", "sg diffuse"});
    }
    SUBCASE("everything")
    {
        Scene scene = buildSquare(metal(glm::vec3(0.5f), 0.4f));
        scene.lights = {PunctualLight{.position = {0.0f, 0.0f, 3.0f}}};
        scene.environment = Environment{CpuImage(16, 8, glm::vec4(1.0f))};
        SgBake bake = plain;
        bake.environment = plain.radiance;
        const FrameResult frame = render(scene, bake, cameraAt(0.0f));
        CHECK(frame.passes == Names{"visibility", "surfaces", "sg diffuse", "sg specular",
                                    "punctual lights", "sg diffuse environment",
                                    "environment prefilter", "sg environment", "sky",
                                    "downsample"});
        CHECK(frame.skipped.empty());
    }
    SUBCASE("views leave out what they do not show")
    {
        const FrameResult frame = render(buildSquare(metal(glm::vec3(0.5f), 0.4f)), plain,
                                         cameraAt(0.0f), {.view = RenderView::Specular});
        CHECK(frame.passes == Names{"visibility", "surfaces", "sg specular", "downsample"});
    }
}

TEST_CASE("shade: an unoccluded white environment returns the metal's albedo, smooth or rough")
{
    const glm::vec3 color(0.9f, 0.6f, 0.3f);
    for (const float roughness : {0.05f, 0.4f, 1.0f}) {
        Scene scene = buildSquare(metal(color, roughness));
        scene.environment = Environment{CpuImage(32, 16, glm::vec4(1.0f))};
        SgBake bake = bakeOf(scene, kUp, 1e-4f, glm::vec3(0.0f));
        bake.environment = bakeOf(scene, kUp, 1e-4f, glm::vec3(1.0f)).radiance;
        const FrameResult frame = render(scene, bake, cameraAt(20.0f));
        const gpu::SgMixture mixture = specularTable().mixture(roughness * roughness, kUp,
                                                               glm::normalize(cameraAt(20.0f).eye));
        CAPTURE(roughness);
        checkClose(centre(frame), color * mixture.scale + mixture.bias, 0.02);
    }
}

TEST_CASE("shade: the sky shows the environment")
{
    Scene scene = buildSquare(lambert(glm::vec3(0.5f)));
    CpuImage latLong(64, 32);
    for (std::uint32_t y = 0; y < 32; ++y)
        for (std::uint32_t x = 0; x < 64; ++x)
            latLong.at(x, y) = glm::vec4(float(x) / 64.0f, float(y) / 32.0f, 0.5f, 1.0f);
    scene.environment = Environment{latLong};
    SgBake bake = bakeOf(scene, kUp, 1.0f, glm::vec3(1.0f));
    bake.environment = bake.radiance;
    const Camera away{
        .eye = {0.0f, 0.0f, 2.0f}, .target = {1.0f, 0.4f, 4.0f}, .verticalFovDegrees = 40.0f};
    const FrameResult frame = render(scene, bake, away, {.supersample = 1});
    const gpu::CameraRays rays = cameraRays(away, 16, 16);
    for (const std::uint32_t y : {0u, 7u, 15u})
        for (const std::uint32_t x : {0u, 5u, 15u})
            checkClose(glm::vec3(frame.radiance.at(x, y)),
                       environmentRadiance(*scene.environment,
                                           gpu::cameraRayDirection(rays, glm::vec2(x, y) + 0.5f)),
                       1e-3);
}

TEST_CASE("shade: a point light, and its shadow")
{
    Scene scene = buildSquare(lambert(glm::vec3(0.5f)));
    scene.lights = {PunctualLight{.position = {0.5f, 0.0f, 1.5f}, .intensity = glm::vec3(10.0f)}};
    const SgBake bake = bakeOf(scene, kUp, 1.0f, glm::vec3(0.0f));
    const glm::vec3 lit = centre(render(scene, bake, cameraAt(0.0f)));
    const float squared = 0.5f * 0.5f + 1.5f * 1.5f;
    const float cosine = 1.5f / std::sqrt(squared);
    // The picture's centre is up to a pixel away from the origin: 0.5 % of the distance.
    checkClose(lit, glm::vec3(0.5f / gpu::kPi * 10.0f * cosine / squared), 0.02);

    // A small triangle half way to the light.
    const auto base = std::uint32_t(scene.vertices.size());
    for (const glm::vec3 p : {glm::vec3(0.15f, -0.1f, 0.75f), glm::vec3(0.4f, -0.1f, 0.75f),
                              glm::vec3(0.25f, 0.2f, 0.75f)}) {
        Vertex vertex;
        vertex.position = p;
        scene.vertices.push_back(vertex);
    }
    scene.triangles.push_back({base, base + 1, base + 2});
    scene.triangleMaterials.push_back(0);
    const SgBake withBlocker = bakeOf(scene, kUp, 1.0f, glm::vec3(0.0f));
    checkClose(centre(render(scene, withBlocker, cameraAt(0.0f))), glm::vec3(0.0f), 1e-6);
}

TEST_CASE("shade: the lobes view shows the light field itself")
{
    const Scene scene = buildSquare(lambert(glm::vec3(0.5f)));
    const glm::vec3 axis = glm::normalize(glm::vec3(-0.4f, 0.1f, 0.9f));
    const SgBake bake = bakeOf(scene, axis, 20.0f, glm::vec3(3.0f, 2.0f, 1.0f));
    const Camera camera = cameraAt(25.0f);
    const FrameResult frame = render(scene, bake, camera, {.view = RenderView::Lobes});
    const glm::vec3 view = glm::normalize(camera.eye);
    const float value = gpu::sgEvaluate(glm::vec3(-view.x, -view.y, view.z), axis, 20.0f);
    checkClose(centre(frame), value * glm::vec3(3.0f, 2.0f, 1.0f), 0.02);
}

TEST_CASE("shade: tone mapping and downsampling")
{
    CpuImage pixels(4, 2, glm::vec4(0.25f));
    pixels.at(0, 0) = glm::vec4(1.0f, 0.0f, 0.5f, 1.0f);
    pixels.at(2, 1) = glm::vec4(std::nanf(""));
    Image image(test::context(), {4, 2, 1, Format::RGBA32F, 1}, "pixels");
    image.upload(pixels);
    RenderGraph graph(test::context());
    const ImageId source = graph.importImage(image);
    const ImageId half = addDownsamplePass(graph, source, 2);
    const ImageId display = addTonemapPass(graph, source, {.exposure = 1.0f});
    graph.output(half);
    graph.output(display);
    graph.run();
    CHECK(graph.read(half).at(0, 0).x == doctest::Approx((1.0f + 3.0f * 0.25f) / 4.0f));
    CHECK(graph.read(half).at(0, 0).y == doctest::Approx(3.0f * 0.25f / 4.0f));
    // One stop up: 0.25 becomes 0.5, whose sRGB code is 0.735; 8 bits.
    CHECK(graph.read(display).at(1, 0).x == doctest::Approx(0.7354f).epsilon(4e-3));
    const glm::vec4 broken = graph.read(display).at(2, 1);
    CHECK(broken.x == 1.0f);
    CHECK(broken.y == 0.0f);
    CHECK_THROWS_AS(addDownsamplePass(graph, source, 3), Error);
}

TEST_CASE("shade: inputs that do not belong together are refused")
{
    const Scene scene = buildSquare(lambert(glm::vec3(0.5f)));
    SgBake bake = bakeOf(scene, kUp, 1.0f, glm::vec3(1.0f));
    CHECK_THROWS_AS(render(scene, bake, cameraAt(0.0f), {.supersample = 0}), Error);
    Scene withEnvironment = scene;
    withEnvironment.environment = Environment{CpuImage(8, 4, glm::vec4(1.0f))};
    CHECK_THROWS_AS(render(withEnvironment, bake, cameraAt(0.0f)), Error);
    bake.radiance.lobes.pop_back();
    CHECK_THROWS_AS(render(scene, bake, cameraAt(0.0f)), Error);
    bake.atlas.corners.clear();
    CHECK_THROWS_AS(render(scene, bake, cameraAt(0.0f)), Error);
}
