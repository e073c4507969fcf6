// Cameras: a default one for scenes without, and the forms that the tracer and the rasteriser use.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "engine/scene/scene.hpp"
#include "shaders/shared/camera_types.h"

namespace strandlight {

// The file's first camera. Else one that frames the scene: from inside, looking along the longer
// side, when the scene closes around its centre (a room); from outside otherwise.
Camera defaultCamera(const Scene& scene);

// Near and far plane that enclose the scene as seen from the camera, in metres.
struct DepthRange
{
    float nearPlane = 0.01f;
    float farPlane = 100.0f;
};
DepthRange cameraDepthRange(const Scene& scene, const Camera& camera);

// World to Vulkan clip space: y down, depth 0 (near) to 1 (far). Throws Error when the camera is
// degenerate.
glm::mat4 cameraViewProjection(const Camera& camera, std::uint32_t width, std::uint32_t height,
                               DepthRange range);

// The rays of the same picture. Throws Error when the camera is degenerate.
gpu::CameraRays cameraRays(const Camera& camera, std::uint32_t width, std::uint32_t height);

} // namespace strandlight
