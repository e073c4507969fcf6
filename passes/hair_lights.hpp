// Which lights fall on hair, and how their shadow maps see it.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/hair.hpp"
#include "engine/scene/scene.hpp"
#include "passes/hair_render.hpp"
#include "shaders/shared/hair_types.h"

namespace strandlight {

struct HairSphere
{
    glm::vec3 centre;
    float radius;
};

// Holds all strands with their widths.
HairSphere boundingSphere(const HairStrands& hair);

// The scene's punctual lights, or the key light of the settings when there is no distant light
// either, each with a shadow matrix that
// holds the hair's bounds and a bias of 1.5 texels.
std::vector<gpu::HairLight> hairLights(const HairStrands& hair, const Scene* opaque,
                                       const HairRenderSettings& settings);

// Towards a distant place: direction and shadow matrix alone.
gpu::HairLight hairShadowDirection(const HairStrands& hair, const Scene* opaque, glm::vec3 towards,
                                   std::uint32_t shadowSize);

// Of one light in the illumination; distant light counts as one more.
float hairLightShare(std::span<const gpu::HairLight> lights, const HairRenderSettings& settings);

// A light inside the hair's bounding sphere has no map that holds it all.
bool hairLightCastsShadow(const HairStrands& hair, const gpu::HairLight& light);

} // namespace strandlight
