// Encoded textures to texels, with the file's claims checked before memory is taken.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/base/image_io.hpp"

namespace strandlight {

// PNG or JPEG. Throws FileError (`name` is the file and the place in it) for other formats, sides
// above kMaximumImageSide, sizes that the bytes cannot hold, truncated and damaged files.
Image8 decodeTexture(std::span<const std::uint8_t> bytes, const std::string& name);

} // namespace strandlight
