// Distant environments from files. The mapping between directions and texels is in
// shaders/shared/environment.h.
#pragma once

#include <filesystem>

#include "engine/scene/scene.hpp"
#include "shaders/shared/environment.h"

namespace strandlight {

// Radiance .hdr or OpenEXR .exr, lat-long. Throws FileError for other formats, damaged or truncated
// files, values that are not finite and pictures without any light. Negative values (ringing)
// become 0, which is logged.
Environment loadEnvironment(const std::filesystem::path& path);

// Bilinear radiance of a direction; wraps around in u, ends at the poles in v.
glm::vec3 environmentRadiance(const Environment& environment, glm::vec3 direction);

} // namespace strandlight
