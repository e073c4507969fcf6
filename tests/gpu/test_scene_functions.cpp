// Materials, textures, lights and the environment mapping mean the same on the device as in C++.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/graph/render_graph.hpp"
#include "engine/scene/texture_pool.hpp"
#include "kernels/scene.gen.hpp"
#include "shaders/shared/environment.h"
#include "shaders/shared/rng.h"
#include "shaders/shared/scene_echo.h"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

static_assert(sizeof(gpu::SceneEcho) == gpu::kSceneEchoFloats * sizeof(float));

Texture randomTexture(std::uint32_t width, std::uint32_t height, TextureWrap u, TextureWrap v)
{
    Texture texture;
    texture.width = width;
    texture.height = height;
    texture.wrapU = u;
    texture.wrapV = v;
    for (std::uint32_t i = 0; i < width * height * 4; ++i)
        texture.rgba.push_back(static_cast<std::uint8_t>(gpu::hashPcg(i + 977 * width)));
    return texture;
}

// Materials with every texture slot, none, and transforms; lights of every type.
Scene exampleScene()
{
    Scene scene;
    scene.textures.push_back(
        randomTexture(16, 8, TextureWrap::Repeat, TextureWrap::MirroredRepeat));
    scene.textures.push_back(randomTexture(5, 7, TextureWrap::ClampToEdge, TextureWrap::Repeat));
    Material plain;
    plain.baseColor = glm::vec4(0.2f, 0.4f, 0.6f, 0.8f);
    plain.specular = 0.5f;
    plain.specularColor = glm::vec3(0.9f, 0.5f, 0.1f);
    scene.materials.push_back(plain);
    Material full = plain;
    full.emissive = glm::vec3(3.0f, 2.0f, 1.0f);
    full.alphaCutoff = 0.5f;
    full.doubleSided = true;
    full.normalScale = 0.7f;
    full.baseColorTexture = {0, 0, glm::mat3(0.8f, 0.6f, 0, -1.2f, 1.6f, 0, 0.3f, 0.1f, 1)};
    full.metallicRoughnessTexture = {1, 1, glm::mat3(1.0f)};
    full.normalTexture = {1, 0, glm::mat3(2.0f, 0, 0, 0, 2.0f, 0, 0, 0, 1)};
    full.emissiveTexture = {0, 1, glm::mat3(1.0f)};
    scene.materials.push_back(full);
    for (const LightType type : {LightType::Point, LightType::Spot, LightType::Directional}) {
        PunctualLight light;
        light.type = type;
        light.position = glm::vec3(0.5f, 1.0f, -0.5f);
        light.direction = glm::normalize(glm::vec3(0.2f, -1.0f, 0.1f));
        light.intensity = glm::vec3(5.0f, 3.0f, 1.0f);
        light.range = type == LightType::Point ? 2.5f : 0.0f;
        scene.lights.push_back(light);
    }
    return scene;
}

gpu::SceneEchoQuery queryOf(std::uint32_t i)
{
    const glm::vec3 a = gpu::uniform3(i, 0, 0, 11);
    const glm::vec3 b = gpu::uniform3(i, 0, 1, 11);
    const glm::vec3 c = gpu::uniform3(i, 0, 2, 11);
    const glm::vec3 d = gpu::uniform3(i, 0, 3, 11);
    gpu::SceneEchoQuery q{};
    q.uv0 = glm::vec2(a.x, a.y) * 6.0f - 3.0f;
    q.uv1 = glm::vec2(a.z, b.x) * 6.0f - 3.0f;
    q.lod = i % 3 == 0 ? kFullResolution : -6.0f * b.y;
    q.material = i % 2;
    q.direction = c * 2.0f - 1.0f;
    q.point = d * 4.0f - 2.0f;
    q.light = i % 3;
    return q;
}

gpu::SceneEcho echoOf(const gpu::SceneEchoQuery& q, const TexturePool& pool,
                      const std::vector<gpu::GpuMaterial>& materials,
                      const std::vector<gpu::GpuLight>& lights)
{
    const SurfaceMaterial m = evaluateMaterial(pool, materials[q.material], q.uv0, q.uv1, q.lod);
    gpu::SceneEcho e{};
    e.baseColor = glm::vec4(m.baseColor, m.alpha);
    e.emissive = m.emissive;
    e.metallic = m.metallic;
    e.normal = m.normal;
    e.roughness = m.roughness;
    e.specular = m.specularColor * m.specular;
    e.flags = (m.doubleSided ? 1.0f : 0.0f) + (m.alphaCutoff >= 0.0f ? 2.0f : 0.0f);
    e.environmentUv = gpu::environmentUv(q.direction);
    e.environmentDirection = gpu::environmentDirection(e.environmentUv.x, e.environmentUv.y);
    glm::vec3 toLight;
    e.irradiance = gpu::punctualIrradiance(lights[q.light], q.point, toLight, e.lightDistance);
    e.maskAlpha =
        evaluateMaterial(pool, materials[q.material], q.uv0, q.uv1, kFullResolution).alpha;
    return e;
}

} // namespace

TEST_CASE("scene functions: device and C++ agree")
{
    constexpr std::uint32_t kItems = 6000;
    const Scene scene = exampleScene();
    const TexturePool pool = packTextures(scene);
    const std::vector<gpu::GpuMaterial> materials = packMaterials(scene);
    const std::vector<gpu::GpuLight> lights = packLights(scene);
    std::vector<gpu::SceneEchoQuery> queries;
    for (std::uint32_t i = 0; i < kItems; ++i)
        queries.push_back(queryOf(i));

    RenderGraph graph(test::context());
    const BufferId words =
        graph.uploadBuffer("textures", std::span<const std::uint32_t>(pool.words));
    const BufferId texels =
        graph.uploadBuffer("materials", std::span<const gpu::GpuMaterial>(materials));
    const BufferId lightList = graph.uploadBuffer("lights", std::span<const gpu::GpuLight>(lights));
    const BufferId list =
        graph.uploadBuffer("queries", std::span<const gpu::SceneEchoQuery>(queries));
    BufferId echoes = graph.createBuffer("echoes", std::uint64_t(kItems) * sizeof(gpu::SceneEcho));
    PassBuilder pass = graph.addComputePass("scene echo");
    for (const BufferId input : {words, texels, lightList, list})
        pass.read(input);
    echoes = pass.write(echoes);
    pass.dispatch(kernels::scene_echo, {kItems, 1, 1}, gpu::SceneEchoPush{kItems},
                  {words, texels, lightList, list, echoes});
    graph.output(echoes);
    graph.run();
    const std::vector<float> device = graph.read<float>(echoes);
    REQUIRE(device.size() == std::size_t(kItems) * gpu::kSceneEchoFloats);

    std::uint32_t failures = 0;
    double worst = 0.0;
    for (std::uint32_t i = 0; i < kItems; ++i) {
        const gpu::SceneEcho echo = echoOf(queries[i], pool, materials, lights);
        float expected[gpu::kSceneEchoFloats];
        std::memcpy(expected, &echo, sizeof(expected));
        for (std::uint32_t v = 0; v < gpu::kSceneEchoFloats; ++v) {
            const double actual = device[std::size_t(i) * gpu::kSceneEchoFloats + v];
            // The device's log2, pow and atan are a few 1e-6 off (measured here: 2e-6 in all).
            const double allowed = 1e-5 * std::abs(double(expected[v])) + 2e-5;
            const double error = std::abs(actual - double(expected[v])) / allowed;
            worst = std::max(worst, error);
            if (!(error <= 1.0) && failures++ < 5) {
                CAPTURE(i);
                CAPTURE(v);
                CAPTURE(expected[v]);
                CHECK(actual == doctest::Approx(expected[v]));
            }
        }
    }
    MESSAGE("largest error is " << 100.0 * worst << " % of what is allowed");
    CHECK(failures == 0);
    CHECK(test::context().validationMessages() == 0);
}
