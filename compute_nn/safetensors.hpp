// Named tensors in a file: the safetensors format (8 bytes of header length, a JSON header, raw
// little-endian data). https://github.com/huggingface/safetensors
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace strandlight {

struct NamedTensor
{
    std::vector<std::uint64_t> shape;
    std::vector<float> values; // row-major; F16 files are widened
};

std::string shapeText(const std::vector<std::uint64_t>& shape); // "[32,25,3,3]"

class Safetensors
{
public:
    std::map<std::string, std::string> metadata;
    std::map<std::string, NamedTensor> tensors;

    // Every length, offset and shape is checked against the file before memory is taken for it.
    // Throws FileError naming the tensor and the reason. Reads F32 and F16.
    static Safetensors load(const std::filesystem::path& path);
    // The same of bytes in memory; `name` stands for the path in errors.
    static Safetensors parse(std::span<const std::byte> bytes, const std::string& name);

    // Atomically; F32.
    void save(const std::filesystem::path& path) const;

    bool has(const std::string& name) const { return tensors.count(name) != 0; }
};

} // namespace strandlight
