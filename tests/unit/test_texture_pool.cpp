// The texture pool against direct arithmetic on the textures. The GLSL twin is compared in
// tests/gpu.
#include <doctest/doctest.h>

#include <cmath>

#include "engine/base/image_io.hpp"
#include "engine/base/log.hpp"
#include "engine/scene/procedural.hpp"
#include "engine/scene/texture_pool.hpp"
#include "shaders/shared/rng.h"

using namespace strandlight;

namespace {

Texture randomTexture(std::uint32_t width, std::uint32_t height, std::uint32_t seed)
{
    Texture texture;
    texture.width = width;
    texture.height = height;
    for (std::uint32_t i = 0; i < width * height * 4; ++i)
        texture.rgba.push_back(static_cast<std::uint8_t>(gpu::hashPcg(i + 977 * seed)));
    return texture;
}

// One material with the texture as base colour (sRGB) and, when asked, as metallic-roughness
// (linear).
Scene sceneWith(const Texture& texture, bool linearToo = false)
{
    Scene scene;
    scene.textures.push_back(texture);
    Material& material = scene.materials.emplace_back();
    material.baseColorTexture.texture = 0;
    if (linearToo)
        material.metallicRoughnessTexture.texture = 0;
    return scene;
}

glm::vec4 texelOf(const Texture& texture, std::uint32_t x, std::uint32_t y, bool srgb)
{
    const std::uint8_t* p = texture.rgba.data() + 4 * (std::size_t(y) * texture.width + x);
    glm::vec4 c = glm::vec4(p[0], p[1], p[2], p[3]) / 255.0f;
    if (srgb)
        c = glm::vec4(decodeSrgb(c.x), decodeSrgb(c.y), decodeSrgb(c.z), c.w);
    return c;
}

bool near(glm::vec4 a, glm::vec4 b, float tolerance)
{
    return glm::all(glm::lessThanEqual(glm::abs(a - b), glm::vec4(tolerance)));
}

// A few fp32 operations on values up to 1; coordinates near 1000 would need more, those here are
// below 8.
constexpr float kTolerance = 2e-5f;

} // namespace

TEST_CASE("texel centres give the texels, linear and sRGB, all wrap modes")
{
    for (const TextureWrap mode :
         {TextureWrap::Repeat, TextureWrap::ClampToEdge, TextureWrap::MirroredRepeat}) {
        Texture texture = randomTexture(5, 3, 1);
        texture.wrapU = mode;
        texture.wrapV = mode;
        const TexturePool pool = packTextures(sceneWith(texture, true));
        for (int y = -4; y < 8; ++y) {
            for (int x = -7; x < 13; ++x) {
                const auto wrapped = [&](int i, int size) {
                    if (mode == TextureWrap::ClampToEdge)
                        return std::min(std::max(i, 0), size - 1);
                    const int repeat = int(std::floor(float(i) / float(size)));
                    const int inside = i - repeat * size;
                    const bool mirror = mode == TextureWrap::MirroredRepeat && repeat % 2 != 0;
                    return mirror ? size - 1 - inside : inside;
                };
                const glm::vec2 uv((float(x) + 0.5f) / 5.0f, (float(y) + 0.5f) / 3.0f);
                const auto tx = static_cast<std::uint32_t>(wrapped(x, 5));
                const auto ty = static_cast<std::uint32_t>(wrapped(y, 3));
                CHECK(near(sampleTexture(pool, 0, uv, kFullResolution),
                           texelOf(texture, tx, ty, false), kTolerance));
                CHECK(near(sampleTexture(pool, 1, uv, kFullResolution),
                           texelOf(texture, tx, ty, true), kTolerance));
            }
        }
    }
}

TEST_CASE("between texels the lookup is bilinear in linear light")
{
    const Texture texture = randomTexture(4, 4, 2);
    const TexturePool pool = packTextures(sceneWith(texture));
    const glm::vec4 left = texelOf(texture, 1, 2, true);
    const glm::vec4 right = texelOf(texture, 2, 2, true);
    CHECK(near(sampleTexture(pool, 1, {1.75f / 4, 2.5f / 4}, kFullResolution),
               glm::mix(left, right, 0.25f), kTolerance));
    // Far away coordinates repeat; 4096.4375 is exact in fp32.
    CHECK(near(sampleTexture(pool, 1, {4096.0f + 0.4375f, 0.625f}, kFullResolution),
               glm::mix(left, right, 0.25f), kTolerance));
}

TEST_CASE("the last level is the mean in linear light, also of odd sizes")
{
    for (const glm::uvec2 size : {glm::uvec2(8, 8), glm::uvec2(16, 4), glm::uvec2(1, 1)}) {
        const Texture texture = randomTexture(size.x, size.y, 3);
        const TexturePool pool = packTextures(sceneWith(texture));
        glm::vec4 mean(0.0f);
        for (std::uint32_t y = 0; y < size.y; ++y) {
            for (std::uint32_t x = 0; x < size.x; ++x)
                mean += texelOf(texture, x, y, true) / float(size.x * size.y);
        }
        // Stored in 8 bits, sRGB: half a step is at most 0.0045 in linear light.
        CHECK(near(sampleTexture(pool, 1, {0.3f, 0.7f}, 10.0f), mean, 0.0045f));
    }
    Texture plain = randomTexture(7, 3, 4);
    for (std::size_t i = 0; i < plain.rgba.size(); ++i)
        plain.rgba[i] = static_cast<std::uint8_t>(40 * (i % 4));
    const TexturePool pool = packTextures(sceneWith(plain));
    for (const float lod : {-3.0f, -2.0f, -1.4f, -0.5f, 0.0f})
        CHECK(near(sampleTexture(pool, 1, {0.9f, 0.1f}, lod), texelOf(plain, 0, 0, true),
                   kTolerance));
}

TEST_CASE("levels blend by the footprint")
{
    const Texture texture = randomTexture(8, 8, 5);
    const TexturePool pool = packTextures(sceneWith(texture));
    // A footprint of 2^-3 is one texel of the finest of four levels; 2^-1.75 lies a quarter past
    // level 1.
    const glm::vec2 uv(0.41f, 0.77f);
    const glm::vec4 one = sampleTexture(pool, 1, uv, -2.0f);
    const glm::vec4 two = sampleTexture(pool, 1, uv, -1.0f);
    CHECK(
        near(sampleTexture(pool, 1, uv, -3.0f), sampleTexture(pool, 1, uv, kFullResolution), 0.0f));
    CHECK(near(sampleTexture(pool, 1, uv, -1.75f), glm::mix(one, two, 0.25f), kTolerance));
}

TEST_CASE("a pool over its limit is halved, the largest textures first, and says so")
{
    Scene scene = sceneWith(randomTexture(64, 64, 6));
    scene.textures.push_back(randomTexture(8, 8, 7));
    scene.materials.emplace_back().emissiveTexture.texture = 1;
    int warnings = 0;
    const LogSink previous = setLogSink([&](LogLevel level, const std::string&) {
        warnings += level == LogLevel::Warning ? 1 : 0;
    });
    const TexturePool whole = packTextures(scene);
    CHECK(warnings == 0);
    CHECK(whole.halvings == 0);
    const TexturePool small = packTextures(scene, 8000);
    setLogSink(previous);
    CHECK(warnings == 1);
    CHECK(small.halvings == 1);
    CHECK(small.words.size() * 4 <= 8000);
    CHECK((small.words[gpu::kTextureRecordWords] & 0xffffu) == 32); // 64 halved
    CHECK((small.words[3 * gpu::kTextureRecordWords] & 0xffffu) == 8);
    CHECK_THROWS(packTextures(scene, 16));
}

TEST_CASE("what a material has not costs nothing")
{
    CHECK(packTextures(buildDarkBoxScene()).words.empty());
    Scene unused = sceneWith(randomTexture(64, 64, 8));
    unused.materials[0].baseColorTexture.texture = -1;
    CHECK(packTextures(unused).words.empty());
    // Only the sRGB reading has texels.
    const TexturePool pool = packTextures(sceneWith(randomTexture(4, 4, 9)));
    CHECK(pool.words.size() == 2 * gpu::kTextureRecordWords + 16 + 4 + 1);
    CHECK(packMaterials(buildDarkBoxScene()).at(0).flags == 0.0f);
}

TEST_CASE("materials: textures multiply factors, transforms apply, normal maps scale")
{
    const Texture texture = randomTexture(4, 4, 10);
    Scene scene = sceneWith(texture, true);
    Material& material = scene.materials[0];
    material.baseColor = glm::vec4(0.5f, 0.25f, 1.0f, 0.5f);
    material.metallic = 0.5f;
    material.roughness = 0.75f;
    material.emissive = glm::vec3(4.0f, 2.0f, 1.0f);
    material.emissiveTexture.texture = 0;
    material.emissiveTexture.texCoord = 1;
    material.normalTexture.texture = 0;
    material.normalScale = 0.5f;
    // (u, v) -> (v, u): the slot of the base colour looks up the transposed texel.
    material.baseColorTexture.transform = glm::mat3(0, 1, 0, 1, 0, 0, 0, 0, 1);
    const TexturePool pool = packTextures(scene);
    const SurfaceMaterial m =
        evaluateMaterial(pool, packMaterials(scene).at(0), glm::vec2(0.625f, 0.375f),
                         glm::vec2(0.125f, 0.875f), kFullResolution);
    CHECK(near(glm::vec4(m.baseColor, m.alpha), material.baseColor * texelOf(texture, 1, 2, true),
               kTolerance));
    const glm::vec4 linear = texelOf(texture, 2, 1, false);
    CHECK(m.roughness == doctest::Approx(0.75f * linear.y));
    CHECK(m.metallic == doctest::Approx(0.5f * linear.z));
    CHECK(near(glm::vec4(m.emissive, 0),
               glm::vec4(4, 2, 1, 0) * glm::vec4(glm::vec3(texelOf(texture, 0, 3, true)), 0),
               4 * kTolerance));
    const glm::vec3 n =
        glm::normalize((2.0f * glm::vec3(linear) - 1.0f) * glm::vec3(0.5f, 0.5f, 1.0f));
    CHECK(near(glm::vec4(m.normal, 0), glm::vec4(n, 0), kTolerance));
}

TEST_CASE("punctual lights: inverse square, range, cone, direction")
{
    Scene scene;
    PunctualLight& light = scene.lights.emplace_back();
    light.type = LightType::Spot;
    light.position = glm::vec3(0.0f, 2.0f, 0.0f);
    light.direction = glm::vec3(0.0f, -1.0f, 0.0f);
    light.intensity = glm::vec3(8.0f, 4.0f, 2.0f);
    light.innerConeCos = std::cos(0.2f);
    light.outerConeCos = std::cos(0.4f);
    glm::vec3 toLight;
    float distance = 0.0f;
    gpu::GpuLight spot = packLights(scene).at(0);
    const glm::vec3 below = gpu::punctualIrradiance(spot, glm::vec3(0.0f), toLight, distance);
    CHECK(glm::length(below - glm::vec3(2.0f, 1.0f, 0.5f)) < 1e-5f);
    CHECK(toLight == glm::vec3(0.0f, 1.0f, 0.0f));
    CHECK(distance == 2.0f);
    const float aside = 2.0f * std::tan(0.41f);
    CHECK(gpu::punctualIrradiance(spot, {aside, 0, 0}, toLight, distance) == glm::vec3(0.0f));
    spot.range = 2.0f;
    CHECK(gpu::punctualIrradiance(spot, glm::vec3(0.0f), toLight, distance) == glm::vec3(0.0f));
    scene.lights[0].type = LightType::Directional;
    CHECK(gpu::punctualIrradiance(packLights(scene).at(0), {5, -9, 4}, toLight, distance) ==
          light.intensity);
}
