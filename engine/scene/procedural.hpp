// Scenes that need no file: for a first run, for goldens and for tests with a known answer.
#pragma once

#include "engine/scene/scene.hpp"

namespace strandlight {

// A furnished room of 4 x 3 x 5 m lit by a ceiling panel: about 1,400 triangles, closed, no
// environment needed.
Scene buildRoomScene();

// A closed white box of 2 m seen from inside: Lambert albedo rho, emission 1 on every face.
// Radiance is 1 / (1 - rho) everywhere. Throws Error unless 0 <= albedo < 1.
Scene buildFurnaceScene(float albedo);

// A grey box on a floor and no light at all: what a renderer should skip shows here.
Scene buildDarkBoxScene();

// Nothing but a camera: the picture is the environment, if one is added.
Scene buildEmptyScene();

} // namespace strandlight
