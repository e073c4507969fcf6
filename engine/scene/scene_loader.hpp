// One door to all scenes: built-in ones by name, everything else is a glTF file.
#pragma once

#include <string>

#include "engine/scene/scene.hpp"

namespace strandlight {

// `builtin:room`, `builtin:bust` (hair_head.hpp), `builtin:furnace` (albedo 0.5),
// `builtin:furnace:0.8`, `builtin:box` (no light), or the path of a .gltf or .glb file. Throws
// Error for an unknown built-in name, FileError for a file that cannot be used.
Scene loadScene(const std::string& pathOrBuiltin);

} // namespace strandlight
