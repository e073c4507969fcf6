// glTF 2.0: .gltf, .glb, data URIs, and buffers and images beside the file.
// Khronos Group. glTF 2.0 Specification. 2021
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "engine/scene/scene.hpp"

namespace strandlight {

// The file's default scene with node transforms applied. Triangles without area are dropped,
// normals and tangents made where they are missing. Throws FileError (path, place, reason) for
// anything the file gets wrong.
Scene loadGltf(const std::filesystem::path& path);

// The same from memory; `path` serves messages and finds external files beside it.
Scene parseGltf(std::span<const std::uint8_t> bytes, const std::filesystem::path& path);

} // namespace strandlight
