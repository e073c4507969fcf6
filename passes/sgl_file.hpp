// The .sgl file: one bake, self-contained, checked byte by byte.
//
//   magic "\x89SGL\r\n\x1a\n" | u32 version | u32 storage | u64 file bytes | u32 chunk count
//   | u32 CRC-32 of header and table
//   table, per chunk: 4 characters | u32 CRC-32 of the chunk | u64 offset | u64 bytes
//   INFO what the bake was made with         ATLS sizes of the atlas
//   CRNR corners, 20 bytes each, fp32        TEXL texels, 20 bytes each
//   RADL radiance lobes                      ENVL environment lobes (only with one)
// Lobes: u32 per texel | 3 fp32 of the coding | u32 tile size and a mask per tile, where a texel
// need not keep all (version 2) | kept lobes by texel. Little-endian. Chunks follow each other
// without gaps in this order; the same bake gives the same bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "passes/sg_field.hpp"
#include "passes/sgl_lobe.hpp"

namespace strandlight {

// Version 1 is a bake whose texels keep all lobes, and is still written for one; version 2 has
// tiles with masks.
inline constexpr std::uint32_t kSglVersion = 2;

struct SglSaveReport
{
    std::uint64_t fileBytes = 0;
    double lobeBytesPerTexel = 0.0; // of both fields, with the masks of their tiles
    std::uint64_t savedBytes = 0;   // by lobes that are not kept
    std::uint64_t clampedLobes = 0; // negative amplitudes in the packed format
};

// Throws Error for a bake that is not consistent or not finite (see chooseCoding), FileError when
// writing fails; the old file is then untouched.
SglSaveReport saveSgl(const std::filesystem::path& path, const SgBake& bake,
                      SglStorage storage = SglStorage::Packed);

// Throws FileError, naming the chunk, for a file that is cut, altered, of another version or
// inconsistent.
SgBake loadSgl(const std::filesystem::path& path);

// The same in memory; `name` is for messages.
std::vector<std::uint8_t> encodeSgl(const SgBake& bake, SglStorage storage,
                                    SglSaveReport* report = nullptr);
SgBake decodeSgl(std::span<const std::uint8_t> bytes, const std::string& name);

} // namespace strandlight
