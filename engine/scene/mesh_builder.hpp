// Appends simple shapes to a scene: what the built-in scenes are made of.
// Front faces are counter-clockwise seen from outside; texture coordinates are in metres.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "engine/scene/scene.hpp"

namespace strandlight {

// Faces of a box, to be left out where they would lie on another surface.
enum BoxFace : std::uint32_t
{
    kFaceMinX = 1,
    kFaceMaxX = 2,
    kFaceMinY = 4,
    kFaceMaxY = 8,
    kFaceMinZ = 16,
    kFaceMaxZ = 32,
    kFaceAll = 63
};

class MeshBuilder
{
public:
    explicit MeshBuilder(Scene& scene) : scene_(scene) {}

    // Adds a material; shapes that follow use it.
    void useMaterial(const Material& material);

    // Turns the shapes that follow about +y by `degrees` around `pivot`.
    void turn(float degrees, glm::vec3 pivot);

    // Parallelogram origin, origin + u, origin + u + v, origin + v; the normal is cross(u, v).
    void quad(glm::vec3 origin, glm::vec3 u, glm::vec3 v);

    // Axis-aligned box, normals out (inward: seen from inside).
    void box(glm::vec3 low, glm::vec3 high, std::uint32_t faces = kFaceAll, bool inward = false);

    // Icosahedron with each face split into 4^levels; smooth normals.
    void sphere(glm::vec3 centre, float radius, int levels);

    // Upright tube around +y between two heights, no caps; smooth normals.
    void tube(glm::vec3 base, float radius, float height, int sides);

    // Ring around +y: `major` is the ring's radius, `minor` the radius of its cross section.
    void torus(glm::vec3 centre, float major, float minor, int majorSides, int minorSides);

private:
    std::uint32_t addVertex(glm::vec3 position, glm::vec3 normal, glm::vec3 tangent, glm::vec2 uv);
    void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

    Scene& scene_;
    std::uint32_t material_ = 0;
    glm::mat3 rotation_ = glm::mat3(1.0f);
    glm::vec3 pivot_ = glm::vec3(0.0f);
};

} // namespace strandlight
