// The readers behind image_io.hpp, one file each. `name` is for messages.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/image.hpp"

namespace strandlight {

CpuImage decodeExr(std::span<const std::uint8_t> bytes, const std::string& name);
CpuImage decodeHdr(std::span<const std::uint8_t> bytes, const std::string& name);
std::vector<std::uint8_t> encodeExr(const CpuImage& image, const std::string& name);

// Throws FileError when a side is 0 or the picture is over the limits of image_io.hpp.
void checkImageSize(std::uint64_t width, std::uint64_t height, const std::string& name);

// Exactly out.size() bytes from a zlib stream; false when the stream is broken or of another
// length.
bool inflateExactly(std::span<const std::uint8_t> in, std::span<std::uint8_t> out);

} // namespace strandlight
