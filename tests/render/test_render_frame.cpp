// Frames: which passes run, sky, views, output passes, and agreement with the path tracer on where
// things are.
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/scene/environment.hpp"
#include "engine/scene/procedural.hpp"
#include "passes/downsample.hpp"
#include "passes/path_trace.hpp"
#include "passes/tonemap.hpp"
#include "shaders/shared/sg.h"
#include "tests/render/square_scene.hpp"

using namespace strandlight;
using namespace strandlight::test;

TEST_CASE("frame: only what the scene needs runs")
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

TEST_CASE("frame: the sky shows the environment")
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

TEST_CASE("frame: the lobes view shows the light field itself")
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

TEST_CASE("frame: tone mapping and downsampling")
{
    CpuImage pixels(4, 2, glm::vec4(0.25f));
    pixels.at(0, 0) = glm::vec4(1.0f, 0.0f, 0.5f, 1.0f);
    pixels.at(2, 1) = glm::vec4(std::nanf(""));
    Image image(context(), {4, 2, 1, Format::RGBA32F, 1}, "pixels");
    image.upload(pixels);
    RenderGraph graph(context());
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

TEST_CASE("frame: inputs that do not belong together are refused")
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

TEST_CASE("frame: raster and path tracer see the same picture")
{
    // Every surface glows in its base colour, nothing reflects: only where things are can differ.
    Scene scene = buildRoomScene();
    scene.lights.clear();
    for (Material& material : scene.materials) {
        material.emissive = glm::vec3(material.baseColor);
        material.doubleSided = true;
    }
    SgBake bake;
    bake.atlas = buildAtlas(scene, {.resolution = 64});
    bake.radiance = uniformField(bake.atlas, SgLobe{});
    const Camera camera = defaultCamera(scene);
    GpuScene device = uploadScene(context(), scene);
    const FrameResult frame = renderFrame(context(), scene, device, bake, camera,
                                          {.width = 64, .height = 48, .supersample = 4});
    const CpuImage truth = renderReference(
        context(), device, camera, {.width = 64, .height = 48, .samples = 16, .bounces = 0});
    double difference = 0.0;
    std::uint32_t far = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        const glm::vec3 d = glm::abs(glm::vec3(frame.radiance.pixels[i] - truth.pixels[i]));
        difference += (d.x + d.y + d.z) / 3.0;
        far += d.x + d.y + d.z > 0.9f ? 1 : 0;
    }
    // What is left is the noise of 16 random samples on edges; a shift of half a pixel gives 0.02.
    CHECK(difference / double(truth.pixels.size()) < 0.012);
    CHECK(far < truth.pixels.size() / 100);
}
