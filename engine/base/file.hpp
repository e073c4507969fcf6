// Whole files in and out. Output is written beside its place and renamed, so a reader never sees
// half a file and a failed run leaves the old one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace strandlight {

// Throws FileError when the file is missing, unreadable or larger than `maximumBytes`.
std::vector<std::uint8_t> readFile(const std::filesystem::path& path,
                                   std::uint64_t maximumBytes = std::uint64_t(4) << 30);

// Temporary name, fsync, rename. Throws FileError; on failure the target is untouched.
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void writeFileAtomically(const std::filesystem::path& path, std::string_view text);

// Removes `<path>.tmp.<pid>` files of processes that were killed.
void removeStaleTemporaries(const std::filesystem::path& path);

// CRC-32 (IEEE 802.3), as zlib computes it.
std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t seed = 0);

} // namespace strandlight
