// A glTF file after parsing and before meaning: private to gltf_*.cpp, and the only file that
// includes tinygltf.
//
// tinygltf checks the JSON; it does not check that views lie inside buffers, that indices exist or
// that values are finite. Everything that follows an index goes through the functions below.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include "engine/base/error.hpp"
#include "engine/scene/scene.hpp"

namespace strandlight {

// Totals that no sensible scene for this renderer exceeds; checked before memory is taken.
inline constexpr std::uint64_t kMaximumElements = std::uint64_t(1) << 25; // triangles + vertices
inline constexpr std::uint64_t kMaximumFileBytes = (std::uint64_t(1) << 31) - 1;

struct GltfDocument
{
    std::filesystem::path path;
    tinygltf::Model model; // Image::image holds the encoded file of images that have a URI

    [[noreturn]] void fail(const std::string& place, const std::string& reason) const
    {
        throw FileError(path.string(), place, reason);
    }

    // model.things[index] with the index checked.
    template <class T>
    const T& at(const std::vector<T>& things, int index, const char* what,
                const std::string& place) const
    {
        if (index < 0 || std::size_t(index) >= things.size())
            fail(place, std::string("refers to ") + what + " " + std::to_string(index) + " of " +
                            std::to_string(things.size()));
        return things[std::size_t(index)];
    }

    // The bytes of a buffer view, inside its buffer.
    std::span<const unsigned char> view(int index, const std::string& place) const;

    // `count` numbers from JSON as floats; `fallback` when the array is absent. Fails on another
    // length or on values that are not finite.
    void readNumbers(const std::vector<double>& numbers, std::span<float> out,
                     const std::string& place) const;
    float readNumber(double value, const std::string& place) const;
};

// Parses the JSON, loads buffers and encoded images. External files must lie in the asset's
// directory.
GltfDocument readGltfDocument(std::span<const std::uint8_t> bytes,
                              const std::filesystem::path& path);

// Accessor data as floats, tightly packed [count, components]; normalised integers become [0, 1] or
// [-1, 1].
std::vector<float> readFloats(const GltfDocument& document, int accessor, int components,
                              const std::string& place);

// An index accessor: unsigned integers, each below `limit`.
std::vector<std::uint32_t> readIndices(const GltfDocument& document, int accessor,
                                       std::uint64_t limit, const std::string& place);

// Materials, and the textures they use; the last material is glTF's default one, used by primitives
// without.
void readMaterials(const GltfDocument& document, Scene& scene);

// What loading has cost and met so far.
struct GltfProgress
{
    std::uint64_t elementsRead = 0; // triangles and vertices, instances counted each time
    std::uint64_t degenerateTriangles = 0;
    std::uint64_t skippedPrimitives = 0; // points and lines
    bool allHaveTexCoord1 = true;
};

// Appends one primitive, transformed. `place` names it in errors.
void appendPrimitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                     const glm::dmat4& transform, const std::string& place, Scene& scene,
                     GltfProgress& progress);

// KHR_lights_punctual and cameras, placed by a node's transform.
void appendLight(const GltfDocument& document, int light, const glm::dmat4& transform,
                 const std::string& place, Scene& scene);
void appendCamera(const GltfDocument& document, int camera, const glm::dmat4& transform,
                  const std::string& place, Scene& scene);

// Decodes and adds the texture of a slot once; returns its index in Scene::textures.
class GltfTextureCache
{
public:
    GltfTextureCache(const GltfDocument& document, Scene& scene);
    std::int32_t load(int texture, const std::string& place);

private:
    const GltfDocument& document_;
    Scene& scene_;
    std::vector<std::int32_t> loaded_; // by glTF texture index, -1: not yet
    std::uint64_t totalBytes_ = 0;
};

} // namespace strandlight
