// Which lights fall on hair, and how their shadow maps see it.
#pragma once

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

// The scene's punctual lights, or the key light of the settings, each with a shadow matrix that
// holds the hair's bounds and a bias of 1.5 texels.
std::vector<gpu::HairLight> hairLights(const HairStrands& hair, const Scene* opaque,
                                       const HairRenderSettings& settings);

// A light inside the hair's bounding sphere has no map that holds it all.
bool hairLightCastsShadow(const HairStrands& hair, const gpu::HairLight& light);

} // namespace strandlight
