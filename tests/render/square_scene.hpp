// The scene of the shading tests: one square, every texel of its bake the same lobe.
#pragma once

#include <cmath>

#include <doctest/doctest.h>

#include "passes/render_frame.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace strandlight::test {

// A square of 2 m around the origin, facing +z, seen from +z: fills the picture.
inline Scene buildSquare(const Material& material)
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

inline Material lambert(glm::vec3 albedo)
{
    Material material;
    material.baseColor = glm::vec4(albedo, 1.0f);
    material.metallic = 0.0f;
    material.specular = 0.0f;
    return material;
}

inline Material metal(glm::vec3 color, float roughness)
{
    Material material;
    material.baseColor = glm::vec4(color, 1.0f);
    material.roughness = roughness;
    return material;
}

// The frame of the square's atlas: T along growing u.
inline glm::vec3 toSquareFrame(const Atlas& atlas, glm::vec3 direction)
{
    const glm::vec3 n(0.0f, 0.0f, 1.0f);
    const glm::vec3 t = atlas.corners[0].tangent;
    return {glm::dot(t, direction), glm::dot(glm::cross(n, t), direction), direction.z};
}

inline SgField uniformField(const Atlas& atlas, const SgLobe& lobe)
{
    SgField field;
    field.lobeCount = 1;
    field.lobes.assign(atlas.texels.size(), lobe);
    return field;
}

// Every texel holds this one lobe, its axis given in world space.
inline SgBake bakeOf(const Scene& scene, glm::vec3 axis, float lambda, glm::vec3 amplitude)
{
    SgBake bake;
    bake.atlas = buildAtlas(scene, {.resolution = 32});
    bake.radiance =
        uniformField(bake.atlas, {toSquareFrame(bake.atlas, axis), std::log(lambda), amplitude});
    return bake;
}

inline const glm::vec3 kUp(0.0f, 0.0f, 1.0f);

inline Camera cameraAt(float degrees)
{
    const float a = glm::radians(degrees);
    return {.eye = 2.0f * glm::vec3(std::sin(a), 0.0f, std::cos(a)),
            .target = glm::vec3(0.0f),
            .verticalFovDegrees = 5.0f};
}

inline FrameResult render(const Scene& scene, const SgBake& bake, const Camera& camera,
                          RenderSettings settings = {})
{
    settings.width = 16;
    settings.height = 16;
    GpuScene device = uploadScene(context(), scene);
    return renderFrame(context(), scene, device, bake, camera, settings);
}

inline glm::vec3 centre(const FrameResult& frame)
{
    return glm::vec3(frame.radiance.at(8, 8));
}

inline void checkClose(glm::vec3 actual, glm::vec3 expected, double relative)
{
    for (int c = 0; c < 3; ++c)
        CHECK(actual[c] == doctest::Approx(expected[c]).epsilon(relative));
}

} // namespace strandlight::test
