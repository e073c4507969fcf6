#include "engine/scene/procedural.hpp"

#include <string>

#include "engine/base/error.hpp"
#include "engine/scene/mesh_builder.hpp"

namespace strandlight {

namespace {

Material matte(const char* name, glm::vec3 color, float roughness = 0.9f)
{
    Material material;
    material.name = name;
    material.baseColor = glm::vec4(color, 1.0f);
    material.metallic = 0.0f;
    material.roughness = roughness;
    return material;
}

Material metal(const char* name, glm::vec3 color, float roughness)
{
    Material material = matte(name, color, roughness);
    material.metallic = 1.0f;
    return material;
}

// Two tones of tile with a slight difference from tile to tile, and a dark joint. Made of integers
// only, so the bytes are the same everywhere.
Texture checkerTexture()
{
    constexpr std::uint32_t kSize = 128;
    constexpr std::uint32_t kTile = 32;
    Texture texture;
    texture.name = "tiles";
    texture.width = kSize;
    texture.height = kSize;
    texture.rgba.reserve(std::size_t(kSize) * kSize * 4);
    for (std::uint32_t y = 0; y < kSize; ++y) {
        for (std::uint32_t x = 0; x < kSize; ++x) {
            const std::uint32_t column = x / kTile;
            const std::uint32_t row = y / kTile;
            const bool joint = x % kTile == 0 || y % kTile == 0;
            const bool dark = (column + row) % 2 == 1;
            const auto shade = static_cast<std::uint8_t>((column * 7 + row * 13) % 5 * 4);
            const std::uint8_t base[3] = {std::uint8_t(dark ? 112 : 214),
                                          std::uint8_t(dark ? 84 : 198),
                                          std::uint8_t(dark ? 66 : 172)};
            for (const std::uint8_t channel : base)
                texture.rgba.push_back(joint ? std::uint8_t(70) : std::uint8_t(channel - shade));
            texture.rgba.push_back(255);
        }
    }
    return texture;
}

// Floor, walls and ceiling; the ceiling has an opening with a recessed, emissive panel in it.
void addShell(Scene& scene, MeshBuilder& mesh)
{
    Material floor = matte("floor", glm::vec3(1.0f), 0.5f);
    floor.baseColorTexture.texture = static_cast<std::int32_t>(scene.textures.size());
    floor.baseColorTexture.transform = glm::mat3(0.5f, 0, 0, 0, 0.5f, 0, 0, 0, 1); // 2 m a repeat
    scene.textures.push_back(checkerTexture());
    mesh.useMaterial(floor);
    mesh.quad({-2.0f, 0.0f, 2.5f}, {4.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -5.0f});

    mesh.useMaterial(matte("red wall", {0.62f, 0.16f, 0.11f}));
    mesh.quad({-2.0f, 0.0f, 2.5f}, {0.0f, 0.0f, -5.0f}, {0.0f, 3.0f, 0.0f});
    mesh.useMaterial(matte("blue wall", {0.10f, 0.26f, 0.46f}));
    mesh.quad({2.0f, 0.0f, -2.5f}, {0.0f, 0.0f, 5.0f}, {0.0f, 3.0f, 0.0f});

    mesh.useMaterial(matte("white wall", {0.75f, 0.73f, 0.68f}));
    mesh.quad({-2.0f, 0.0f, -2.5f}, {4.0f, 0.0f, 0.0f}, {0.0f, 3.0f, 0.0f});
    mesh.quad({2.0f, 0.0f, 2.5f}, {-4.0f, 0.0f, 0.0f}, {0.0f, 3.0f, 0.0f});
    // The ceiling around the opening x [-0.8, 0.8], z [-1.4, 0.6], and the four sides of the
    // recess.
    mesh.quad({-2.0f, 3.0f, -2.5f}, {4.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.1f});
    mesh.quad({-2.0f, 3.0f, 0.6f}, {4.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.9f});
    mesh.quad({-2.0f, 3.0f, -1.4f}, {1.2f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f});
    mesh.quad({0.8f, 3.0f, -1.4f}, {1.2f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f});
    mesh.box({-0.8f, 3.0f, -1.4f}, {0.8f, 3.08f, 0.6f},
             kFaceMinX | kFaceMaxX | kFaceMinZ | kFaceMaxZ, true);

    Material panel = matte("ceiling panel", glm::vec3(0.0f));
    panel.emissive = glm::vec3(9.0f, 8.3f, 7.2f);
    mesh.useMaterial(panel);
    mesh.quad({-0.8f, 3.08f, -1.4f}, {1.6f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f});
}

// A low table with a ring of brass and a porcelain sphere on it.
void addTable(MeshBuilder& mesh)
{
    constexpr std::uint32_t kNoBottom = kFaceAll & ~std::uint32_t(kFaceMinY);
    constexpr std::uint32_t kSides = kNoBottom & ~std::uint32_t(kFaceMaxY);
    mesh.turn(12.0f, {0.55f, 0.0f, -0.55f});
    mesh.useMaterial(matte("wood", {0.36f, 0.20f, 0.10f}, 0.45f));
    mesh.box({-0.15f, 0.56f, -1.0f}, {1.25f, 0.62f, -0.1f});
    for (const float x : {-0.1f, 1.12f}) {
        for (const float z : {-0.95f, -0.23f})
            mesh.box({x, 0.0f, z}, {x + 0.08f, 0.56f, z + 0.08f}, kSides);
    }
    mesh.useMaterial(metal("brass", {0.91f, 0.72f, 0.36f}, 0.3f));
    mesh.torus({0.9f, 0.684f, -0.5f}, 0.19f, 0.065f, 20, 10);
    mesh.useMaterial(matte("porcelain", {0.80f, 0.80f, 0.78f}, 0.2f));
    mesh.sphere({0.25f, 0.797f, -0.62f}, 0.18f, 2);
    mesh.turn(0.0f, glm::vec3(0.0f));
}

// A steel sphere on a plinth, two crates, and a round pillar with base and capital.
void addObjects(MeshBuilder& mesh)
{
    constexpr std::uint32_t kNoBottom = kFaceAll & ~std::uint32_t(kFaceMinY);
    constexpr std::uint32_t kNoTop = kFaceAll & ~std::uint32_t(kFaceMaxY);
    mesh.useMaterial(matte("stone", {0.58f, 0.55f, 0.50f}));
    mesh.box({-1.15f, 0.0f, -1.05f}, {-0.55f, 0.55f, -0.45f}, kNoBottom);
    mesh.box({1.2f, 0.0f, -2.2f}, {1.7f, 0.18f, -1.7f}, kNoBottom);
    mesh.box({1.2f, 2.82f, -2.2f}, {1.7f, 3.0f, -1.7f}, kNoTop);
    mesh.tube({1.45f, 0.18f, -1.95f}, 0.17f, 2.64f, 20);

    mesh.useMaterial(metal("steel", {0.77f, 0.78f, 0.80f}, 0.3f));
    mesh.sphere({-0.85f, 0.877f, -0.75f}, 0.33f, 2);

    mesh.useMaterial(matte("green crate", {0.22f, 0.42f, 0.16f}, 0.6f));
    mesh.turn(-24.0f, {-1.3f, 0.0f, -1.85f});
    mesh.box({-1.7f, 0.0f, -2.15f}, {-0.9f, 1.35f, -1.55f}, kNoBottom);
    mesh.useMaterial(matte("yellow crate", {0.78f, 0.55f, 0.12f}, 0.6f));
    mesh.turn(31.0f, {-0.42f, 0.0f, 0.1f});
    mesh.box({-0.62f, 0.0f, -0.1f}, {-0.22f, 0.4f, 0.3f}, kNoBottom);
    mesh.turn(0.0f, glm::vec3(0.0f));
}

} // namespace

Scene buildRoomScene()
{
    Scene scene;
    scene.name = "builtin:room";
    MeshBuilder mesh(scene);
    addShell(scene, mesh);
    addTable(mesh);
    addObjects(mesh);

    Camera camera;
    camera.eye = glm::vec3(0.3f, 1.5f, 2.4f);
    camera.target = glm::vec3(0.0f, 1.0f, -0.9f);
    camera.verticalFovDegrees = 60.0f;
    scene.cameras.push_back(camera);
    return scene;
}

Scene buildFurnaceScene(float albedo)
{
    if (!(albedo >= 0.0f && albedo < 1.0f))
        throw Error("builtin:furnace: albedo " + std::to_string(albedo) + " is not in [0, 1)");
    Scene scene;
    scene.name = "builtin:furnace";
    Material white = matte("furnace", glm::vec3(albedo), 1.0f);
    white.specular = 0.0f;
    white.emissive = glm::vec3(1.0f);
    MeshBuilder mesh(scene);
    mesh.useMaterial(white);
    mesh.box(glm::vec3(-1.0f), glm::vec3(1.0f), kFaceAll, true);

    Camera camera;
    camera.eye = glm::vec3(0.1f, 0.2f, 0.7f);
    camera.target = glm::vec3(0.0f);
    camera.verticalFovDegrees = 60.0f;
    scene.cameras.push_back(camera);
    return scene;
}

Scene buildDarkBoxScene()
{
    Scene scene;
    scene.name = "builtin:box";
    MeshBuilder mesh(scene);
    mesh.useMaterial(matte("grey", glm::vec3(0.5f)));
    mesh.quad({-2.0f, 0.0f, 2.0f}, {4.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -4.0f});
    mesh.box({-0.5f, 0.0f, -0.5f}, {0.5f, 1.0f, 0.5f}, kFaceAll & ~std::uint32_t(kFaceMinY));
    return scene;
}

Scene buildEmptyScene()
{
    Scene scene;
    scene.name = "builtin:empty";
    scene.cameras.push_back(Camera{});
    return scene;
}

} // namespace strandlight
