// The head that the built-in grooms grow on: an ellipsoid at the origin, face towards +z.
#pragma once

#include <glm/glm.hpp>

#include "engine/scene/scene.hpp"

namespace strandlight {

inline constexpr glm::vec3 kHeadRadii{0.075f, 0.11f, 0.095f}; // metres

// 1 on the head's surface, less inside, more outside.
float headLevel(glm::vec3 point);

// Unit normal of the ellipsoid through `point` that has the head's centre and proportions.
glm::vec3 headNormal(glm::vec3 point);

// Smallest level on the segment a to b.
float lowestHeadLevel(glm::vec3 a, glm::vec3 b);

// Head and neck as a mesh of about 1,400 triangles inside of the ellipsoid, skin-coloured, under a
// key light and a rim light. The neck is no obstacle to grooms.
Scene headScene();

// The furnished room with the head in it at kBustPlace, lit by the room's lamp alone.
inline constexpr glm::vec3 kBustPlace{0.0f, 1.3f, 0.6f};
Scene buildBustScene();

} // namespace strandlight
