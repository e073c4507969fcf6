// Built-in scenes and cameras.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.hpp"
#include "engine/scene/camera.hpp"
#include "engine/scene/procedural.hpp"
#include "engine/scene/scene_loader.hpp"

using namespace strandlight;

namespace {

void checkWellFormed(const Scene& scene)
{
    REQUIRE(scene.triangles.size() == scene.triangleMaterials.size());
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const glm::uvec3 t = scene.triangles[i];
        REQUIRE(std::max({t.x, t.y, t.z}) < scene.vertices.size());
        REQUIRE(scene.triangleMaterials[i] < scene.materials.size());
        const glm::vec3 a = scene.vertices[t.x].position;
        const glm::vec3 n =
            glm::cross(scene.vertices[t.y].position - a, scene.vertices[t.z].position - a);
        CHECK(glm::length(n) > 1e-6f);
        // Front faces agree with vertex normals: coarse spheres turn by less than 60 degrees within
        // a face.
        for (int k = 0; k < 3; ++k)
            CHECK(glm::dot(glm::normalize(n), scene.vertices[t[k]].normal) > 0.5f);
    }
    for (const Vertex& v : scene.vertices) {
        CHECK(glm::length(v.normal) == doctest::Approx(1.0));
        CHECK(std::abs(glm::dot(v.normal, glm::vec3(v.tangent))) < 1e-4f);
    }
}

// Signed volume of all triangles: for closed surfaces this is their volume, inward ones negative.
double signedVolume(const Scene& scene)
{
    double sum = 0.0;
    for (const glm::uvec3& t : scene.triangles) {
        const glm::dvec3 a = scene.vertices[t.x].position;
        sum += glm::dot(a, glm::cross(glm::dvec3(scene.vertices[t.y].position),
                                      glm::dvec3(scene.vertices[t.z].position))) /
               6.0;
    }
    return sum;
}

glm::vec2 project(const glm::mat4& matrix, glm::vec3 point, float width, float height)
{
    const glm::vec4 clip = matrix * glm::vec4(point, 1.0f);
    return (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(width, height);
}

} // namespace

TEST_CASE("the room is small, well formed and the same every time")
{
    const Scene scene = loadScene("builtin:room");
    checkWellFormed(scene);
    CHECK(scene.triangles.size() <= 1500);
    CHECK(scene.textures.size() == 1);
    CHECK(scene.cameras.size() == 1);
    const Scene again = buildRoomScene();
    CHECK(std::equal(scene.vertices.begin(), scene.vertices.end(), again.vertices.begin(),
                     again.vertices.end(), [](const Vertex& a, const Vertex& b) {
                         return a.position == b.position && a.uv0 == b.uv0;
                     }));
    bool emits = false;
    for (const Material& material : scene.materials)
        emits = emits || material.emissive != glm::vec3(0.0f);
    CHECK(emits);
}

TEST_CASE("no ray leaves the room")
{
    const Scene scene = buildRoomScene();
    const glm::vec3 eye = scene.cameras[0].eye;
    int escaped = 0;
    for (int i = 0; i < 400; ++i) {
        const float z = 1.0f - (2.0f * float(i) + 1.0f) / 400.0f;
        const float r = std::sqrt(1.0f - z * z);
        const glm::vec3 d(r * std::cos(2.39996f * float(i)), r * std::sin(2.39996f * float(i)), z);
        bool hit = false;
        for (const glm::uvec3& t : scene.triangles) {
            const glm::vec3 a = scene.vertices[t.x].position - eye;
            const glm::vec3 b = scene.vertices[t.y].position - eye;
            const glm::vec3 c = scene.vertices[t.z].position - eye;
            // d = x a + y b + z c with x, y, z >= 0 (Cramer's rule, times the determinant).
            const float determinant = glm::dot(a, glm::cross(b, c));
            hit = hit || (glm::dot(d, glm::cross(b, c)) * determinant >= 0.0f &&
                          glm::dot(d, glm::cross(c, a)) * determinant >= 0.0f &&
                          glm::dot(d, glm::cross(a, b)) * determinant >= 0.0f);
        }
        escaped += hit ? 0 : 1;
    }
    CHECK(escaped == 0);
}

TEST_CASE("the furnace is a closed box seen from inside")
{
    const Scene scene = loadScene("builtin:furnace:0.75");
    checkWellFormed(scene);
    CHECK(scene.triangles.size() == 12);
    CHECK(signedVolume(scene) == doctest::Approx(-8.0));
    const Material& material = scene.materials.at(0);
    CHECK(material.baseColor == glm::vec4(0.75f, 0.75f, 0.75f, 1.0f));
    CHECK(material.emissive == glm::vec3(1.0f));
    CHECK(material.specular == 0.0f);
    CHECK(material.metallic == 0.0f);
}

TEST_CASE("the dark box has nothing to light it with")
{
    const Scene scene = loadScene("builtin:box");
    checkWellFormed(scene);
    CHECK(scene.lights.empty());
    CHECK(scene.textures.empty());
    for (const Material& material : scene.materials)
        CHECK(material.emissive == glm::vec3(0.0f));
}

TEST_CASE("default cameras: the scene's own, from outside, from inside")
{
    const Scene room = buildRoomScene();
    CHECK(defaultCamera(room).eye == room.cameras[0].eye);

    const Scene box = buildDarkBoxScene();
    const Camera outside = defaultCamera(box);
    CHECK(glm::any(glm::greaterThan(outside.eye, box.boundsMax())));
    const glm::mat4 matrix =
        cameraViewProjection(outside, 100, 100, cameraDepthRange(box, outside));
    for (const Vertex& vertex : box.vertices) {
        const glm::vec2 pixel = project(matrix, vertex.position, 100.0f, 100.0f);
        CHECK(glm::all(glm::greaterThan(pixel, glm::vec2(0.0f))));
        CHECK(glm::all(glm::lessThan(pixel, glm::vec2(100.0f))));
    }

    Scene cameraless = room;
    cameraless.cameras.clear();
    const Camera inside = defaultCamera(cameraless);
    CHECK(glm::all(glm::greaterThan(inside.eye, room.boundsMin())));
    CHECK(glm::all(glm::lessThan(inside.eye, room.boundsMax())));
}

TEST_CASE("a pixel's ray and the projection matrix agree")
{
    Camera camera;
    camera.eye = glm::vec3(1.0f, 2.0f, 3.0f);
    camera.target = glm::vec3(-2.0f, 0.5f, -1.0f);
    camera.verticalFovDegrees = 50.0f;
    const DepthRange range{0.1f, 50.0f};
    const glm::mat4 matrix = cameraViewProjection(camera, 320, 200, range);
    const gpu::CameraRays rays = cameraRays(camera, 320, 200);
    for (const glm::vec2 pixel :
         {glm::vec2(0.5f, 0.5f), glm::vec2(160.0f, 100.0f), glm::vec2(300.0f, 20.0f)}) {
        const glm::vec3 direction = gpu::cameraRayDirection(rays, pixel);
        CHECK(glm::length(direction) == doctest::Approx(1.0));
        // 1e-2 pixels: fp32 over a few hundred pixels, about 1e-5 relative.
        CHECK(glm::length(project(matrix, camera.eye + 4.0f * direction, 320, 200) - pixel) <
              1e-2f);
    }
    // Rows grow downwards, the near plane has depth 0, the far plane depth 1.
    CHECK(rays.stepY.y < 0.0f);
    const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
    const auto depth = [&](float distance) {
        const glm::vec4 clip = matrix * glm::vec4(camera.eye + forward * distance, 1.0f);
        return clip.z / clip.w;
    };
    CHECK(depth(0.1f) == doctest::Approx(0.0).epsilon(1e-4));
    CHECK(depth(50.0f) == doctest::Approx(1.0).epsilon(1e-4));
}

TEST_CASE("degenerate cameras are refused, looking straight up is not")
{
    Camera camera;
    camera.target = camera.eye;
    CHECK_THROWS_AS(cameraRays(camera, 4, 4), Error);
    camera.target = camera.eye + glm::vec3(0.0f, 3.0f, 0.0f);
    CHECK(std::isfinite(cameraRays(camera, 4, 4).corner.x));
    camera.verticalFovDegrees = 180.0f;
    CHECK_THROWS_AS(cameraRays(camera, 4, 4), Error);
}
