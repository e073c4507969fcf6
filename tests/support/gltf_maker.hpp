// Small glTF files in memory, for tests that break them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace strandlight::test {

// A document under construction: JSON that tests edit freely, and one binary buffer.
struct GltfMaker
{
    nlohmann::json json;
    std::vector<std::uint8_t> binary;

    // Adds data as a buffer view and an accessor; returns the accessor's index.
    int addFloats(const std::vector<float>& values, int components);
    int addIndices(const std::vector<std::uint16_t>& values);
    // Adds an encoded picture as a buffer view, image and texture; returns the texture's index.
    int addTexture(const std::vector<std::uint8_t>& encoded, const std::string& mimeType);

    std::vector<std::uint8_t> glb() const;
    // The .gltf text with the buffer as a data URI, or as `bufferUri` when that is not empty.
    std::vector<std::uint8_t> gltf(const std::string& bufferUri = "") const;

private:
    int addView(const void* data, std::size_t bytes);
};

// Two triangles in the plane z = 0, corners (0,0) to (1,1), one node, one mesh, one primitive with
// normals, texture coordinates and one material with a base colour texture of 2 x 2 texels.
GltfMaker quadGltf();

// A PNG of width x height equal texels.
std::vector<std::uint8_t> plainPng(std::uint32_t width, std::uint32_t height);

// A folder that is removed at the end of a test.
class TemporaryFolder
{
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    // Writes a file into the folder and returns its path.
    std::filesystem::path write(const std::string& name,
                                const std::vector<std::uint8_t>& bytes) const;

private:
    std::filesystem::path path_;
};

} // namespace strandlight::test
