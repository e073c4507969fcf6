#include "engine/scene/camera.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "engine/base/error.hpp"

namespace strandlight {

namespace {

// Orthonormal axes of the picture.
struct Basis
{
    glm::vec3 right;
    glm::vec3 up;
    glm::vec3 forward;
    float tangent; // of half the vertical field of view
};

[[noreturn]] void refuse(const Camera& camera, const char* reason)
{
    std::ostringstream text;
    text << "camera (eye " << camera.eye.x << "," << camera.eye.y << "," << camera.eye.z
         << ", target " << camera.target.x << "," << camera.target.y << "," << camera.target.z
         << ", " << camera.verticalFovDegrees << " degrees): " << reason;
    throw Error(text.str());
}

Basis cameraBasis(const Camera& camera)
{
    const glm::vec3 towards = camera.target - camera.eye;
    const float distance = glm::length(towards);
    if (!(distance > 0.0f) || !std::isfinite(distance))
        refuse(camera, "eye and target must be finite and apart");
    if (!(camera.verticalFovDegrees > 0.0f && camera.verticalFovDegrees < 179.0f))
        refuse(camera, "the field of view must be in (0, 179) degrees");
    Basis basis;
    basis.forward = towards / distance;
    glm::vec3 side = glm::cross(basis.forward, camera.up);
    // Looking straight along `up`: any other up will do, as long as it is always the same.
    if (!(glm::length(side) > 1e-5f * glm::length(camera.up)))
        side = glm::cross(basis.forward, glm::vec3(0.0f, 0.0f, -1.0f));
    if (!(glm::length(side) > 1e-5f))
        side = glm::cross(basis.forward, glm::vec3(1.0f, 0.0f, 0.0f));
    basis.right = glm::normalize(side);
    basis.up = glm::cross(basis.right, basis.forward);
    basis.tangent = std::tan(glm::radians(camera.verticalFovDegrees) * 0.5f);
    return basis;
}

struct Hit
{
    float distance;
    bool front; // the surface faces the ray
};

// The nearest triangle along a ray. Moeller, Trumbore. Fast, Minimum Storage Ray-Triangle
// Intersection. 1997. A plain loop: it runs some forty times per scene.
std::optional<Hit> nearestHit(const Scene& scene, glm::vec3 origin, glm::vec3 direction)
{
    std::optional<Hit> nearest;
    for (const glm::uvec3& t : scene.triangles) {
        const glm::vec3 a = scene.vertices[t.x].position;
        const glm::vec3 ab = scene.vertices[t.y].position - a;
        const glm::vec3 ac = scene.vertices[t.z].position - a;
        const glm::vec3 p = glm::cross(direction, ac);
        const float determinant = glm::dot(ab, p);
        if (determinant == 0.0f)
            continue;
        const float u = glm::dot(origin - a, p) / determinant;
        const glm::vec3 q = glm::cross(origin - a, ab);
        const float v = glm::dot(direction, q) / determinant;
        const float distance = glm::dot(ac, q) / determinant;
        if (u >= 0.0f && v >= 0.0f && u + v <= 1.0f && distance > 0.0f &&
            (!nearest || distance < nearest->distance))
            nearest = Hit{distance, determinant > 0.0f};
    }
    return nearest;
}

// How far one sees along a ray before a surface, or the scene's bounds, ends the view.
float viewDistance(const Scene& scene, glm::vec3 probe, glm::vec3 direction)
{
    if (const std::optional<Hit> hit = nearestHit(scene, probe, direction))
        return hit->distance;
    return std::max(glm::dot(scene.boundsMax() - probe, direction),
                    glm::dot(scene.boundsMin() - probe, direction));
}

// True when most directions from a point meet surfaces that face it: a room, perhaps with windows
// or an open side. A solid object also encloses its centre, but shows it back faces.
bool isEnclosed(const Scene& scene, glm::vec3 probe)
{
    constexpr int kDirections = 32;
    int facing = 0;
    for (int i = 0; i < kDirections; ++i) { // a Fibonacci lattice
        const float z = 1.0f - (2.0f * float(i) + 1.0f) / float(kDirections);
        const float phi = 2.39996323f * float(i);
        const float r = std::sqrt(1.0f - z * z);
        const glm::vec3 direction(r * std::cos(phi), r * std::sin(phi), z);
        const std::optional<Hit> hit = nearestHit(scene, probe, direction);
        facing += hit && hit->front ? 1 : 0;
    }
    return facing * 10 >= kDirections * 6;
}

// With the back against one end of the longer horizontal side, looking along it.
Camera insideCamera(const Scene& scene, glm::vec3 probe, glm::vec3 size)
{
    const glm::vec3 axis = size.x > size.z ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    Camera camera;
    camera.eye = probe + axis * (0.9f * viewDistance(scene, probe, axis));
    camera.target = probe - axis * viewDistance(scene, probe, -axis);
    camera.verticalFovDegrees = 60.0f;
    return camera;
}

} // namespace

Camera defaultCamera(const Scene& scene)
{
    if (!scene.cameras.empty())
        return scene.cameras.front();
    const glm::vec3 low = scene.boundsMin();
    const glm::vec3 size = scene.boundsMax() - low;
    const glm::vec3 centre = low + 0.5f * size;
    // Off the middle by odd amounts, so that symmetric models do not put an edge in the way.
    const glm::vec3 probe = centre + size * glm::vec3(0.0137f, 0.0071f, 0.0093f);
    if (isEnclosed(scene, probe))
        return insideCamera(scene, probe, size);

    Camera camera;
    camera.verticalFovDegrees = 45.0f;
    // The bounding sphere fills the picture's height: radius / sin(half the field of view).
    const float radius = std::max(0.5f * glm::length(size), 1e-3f);
    const float distance = radius / std::sin(glm::radians(22.5f));
    camera.target = centre;
    camera.eye = centre + distance * glm::normalize(glm::vec3(0.6f, 0.45f, 1.0f));
    return camera;
}

DepthRange cameraDepthRange(const Scene& scene, const Camera& camera)
{
    const glm::vec3 low = scene.boundsMin();
    const glm::vec3 high = scene.boundsMax();
    // The farthest corner bounds the far plane; the near plane keeps depth resolution useful in
    // fp32.
    const glm::vec3 farthest = glm::max(glm::abs(low - camera.eye), glm::abs(high - camera.eye));
    DepthRange range;
    range.farPlane = std::max(1.01f * glm::length(farthest), 1e-3f);
    range.nearPlane = 1e-3f * range.farPlane;
    return range;
}

glm::mat4 cameraViewProjection(const Camera& camera, std::uint32_t width, std::uint32_t height,
                               DepthRange range)
{
    const Basis basis = cameraBasis(camera);
    const float aspect = float(width) / float(height);
    const float n = range.nearPlane;
    const float f = range.farPlane;
    const glm::mat3 rows = glm::transpose(glm::mat3(basis.right, basis.up, basis.forward));
    glm::mat4 view(rows);
    view[3] = glm::vec4(-(rows * camera.eye), 1.0f);
    glm::mat4 projection(0.0f); // from (right, up, forward)
    projection[0][0] = 1.0f / (basis.tangent * aspect);
    projection[1][1] = -1.0f / basis.tangent;
    projection[2][2] = f / (f - n);
    projection[2][3] = 1.0f;
    projection[3][2] = -f * n / (f - n);
    return projection * view;
}

gpu::CameraRays cameraRays(const Camera& camera, std::uint32_t width, std::uint32_t height)
{
    const Basis basis = cameraBasis(camera);
    const float halfHeight = basis.tangent;
    const float halfWidth = basis.tangent * float(width) / float(height);
    gpu::CameraRays rays;
    rays.eye = camera.eye;
    rays.corner = basis.forward - halfWidth * basis.right + halfHeight * basis.up;
    rays.stepX = basis.right * (2.0f * halfWidth / float(width));
    rays.stepY = basis.up * (-2.0f * halfHeight / float(height));
    return rays;
}

} // namespace strandlight
