// Where light field images are taken: position and frame of atlas texels.
#pragma once

#include <vector>

#include "engine/scene/atlas.hpp"
#include "engine/scene/scene.hpp"
#include "shaders/shared/path_types.h"

namespace strandlight {

// Position and frame of a texel. Images live in (tangent, cross(normal, tangent), normal).
gpu::CapturePoint capturePoint(const Scene& scene, const Atlas& atlas, const AtlasTexel& texel);
std::vector<gpu::CapturePoint> capturePoints(const Scene& scene, const Atlas& atlas);

} // namespace strandlight
