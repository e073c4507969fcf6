// Tangents for normal maps of meshes that bring none.
#pragma once

#include <cstddef>

#include "engine/scene/scene.hpp"

namespace strandlight {

// Sets Vertex::tangent of the triangles from `firstTriangle` on, by the texture coordinates of
// `slot`. Directions are averaged over a vertex's triangles by corner angle, as MikkTSpace weighs
// them; where mirrored charts meet in one vertex the majority decides (MikkTSpace would split it).
void generateTangents(Scene& scene, std::size_t firstTriangle, const TextureSlot& slot);

} // namespace strandlight
