// How sharply the surface of each texel reflects: where it does, a lobe that is missing is seen.
#pragma once

#include <vector>

#include "engine/scene/atlas.hpp"
#include "engine/scene/scene.hpp"

namespace strandlight {

// F0 (1 - roughness) of the material at every texel's place, of the brightest channel; F0 is the
// reflectance at normal incidence. [texel] 0 to 1.
std::vector<float> texelGloss(const Scene& scene, const Atlas& atlas);

} // namespace strandlight
