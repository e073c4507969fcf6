// Light on hair from far away as a few spherical gaussians and a constant: of an environment, or of
// a bake's light field where the hair is.
#pragma once

#include <cstdint>

#include "engine/scene/hair.hpp"
#include "engine/scene/scene.hpp"
#include "passes/hair_render.hpp"
#include "passes/sg_field.hpp"

namespace strandlight {

inline constexpr std::uint32_t kHairLobes = 6;

// `count` lobes (1 .. 16) of what a direction sees beyond the darkest one, which is the constant.
// Their energy is the environment's, channel by channel. Even light leaves the constant alone.
// Fitted by the bake's own method (sg_fit_reference.hpp), one image of 1,024 directions over the
// whole sphere. Deterministic.
HairDistantLight fitDistantLight(const Environment& environment, std::uint32_t count = kHairLobes);

// Radiance that arrives at `place`, lat-long 64 x 32: the light fields of the 16 nearest texels
// facing each of the six axes, those that look into the direction and are near counting more. What
// no texel looks into, the ground under an open scene, is half as bright as the mean.
// One light for the whole head: texels know the light on their walls, not between them, and a
// head is small against a room. Texels within `radius` are left out (unless there are no others):
// they see the head itself, whose shadow the hair's own maps hold. The bake must be of the scene.
Environment lightFieldAt(const Scene& scene, const SgBake& bake, glm::vec3 place,
                         float radius = 0.0f);

} // namespace strandlight
