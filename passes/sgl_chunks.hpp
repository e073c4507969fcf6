// The chunks of an .sgl file, each by itself: bytes to values and back.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/byte_stream.hpp"
#include "passes/sg_field.hpp"
#include "passes/sgl_lobe.hpp"

namespace strandlight {

std::vector<std::uint8_t> encodeInfo(const BakeInfo& info);
BakeInfo decodeInfo(ByteReader reader);

// Sizes first: the number of corners and texels, which their own chunks must match.
std::vector<std::uint8_t> encodeAtlasSizes(const Atlas& atlas);
Atlas decodeAtlasSizes(ByteReader reader, std::uint64_t& cornerCount, std::uint64_t& texelCount);

std::vector<std::uint8_t> encodeCorners(const Atlas& atlas);
void decodeCorners(ByteReader reader, std::uint64_t count, Atlas& atlas);
std::vector<std::uint8_t> encodeTexels(const Atlas& atlas);
void decodeTexels(ByteReader reader, std::uint64_t count, Atlas& atlas);

// Adds the number of clamped lobes to `clamped`. Throws Error for lobes that cannot be stored.
// Version 1 has every lobe of every texel, version 2 the kept ones.
std::vector<std::uint8_t> encodeField(const SgField& field, const Atlas& atlas,
                                      std::uint32_t version, SglStorage storage,
                                      std::uint64_t& clamped);
SgField decodeField(ByteReader reader, const Atlas& atlas, std::uint32_t version,
                    SglStorage storage);

} // namespace strandlight
