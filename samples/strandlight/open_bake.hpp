// A bake that belongs to a scene.
#pragma once

#include <string>

#include "engine/scene/scene.hpp"
#include "passes/sg_field.hpp"

namespace strandlight::cli {

// Another scene's bake has its texels elsewhere: refused before any work. Throws FileError.
SgBake openBake(const std::string& path, const Scene& scene);

} // namespace strandlight::cli
