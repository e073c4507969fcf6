#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>

#include "engine/base/file.hpp"
#include "engine/base/log.hpp"
#include "engine/scene/gltf_document.h"

namespace strandlight {

namespace {

constexpr std::size_t kMaximumJsonDepth = 64;

// What the file callbacks may touch, and why they refused.
struct AssetFiles
{
    std::filesystem::path directory; // canonical
    std::string refused;
};

bool liesInside(const std::filesystem::path& directory, const std::filesystem::path& file)
{
    const std::filesystem::path relative = file.lexically_relative(directory);
    return !relative.empty() && *relative.begin() != "..";
}

bool assetFileExists(const std::string& name, void* user)
{
    AssetFiles& files = *static_cast<AssetFiles*>(user);
    std::error_code error;
    const std::filesystem::path file = std::filesystem::weakly_canonical(name, error);
    if (error)
        return false;
    if (!liesInside(files.directory, file)) {
        files.refused = name;
        return false;
    }
    return std::filesystem::is_regular_file(file, error);
}

bool readAssetFile(std::vector<unsigned char>* out, std::string* error, const std::string& name,
                   void*)
{
    try {
        *out = readFile(name, kMaximumFileBytes);
        return true;
    } catch (const Error& failure) { // tinygltf is C-minded: failures cross it as text
        *error = failure.what();
        return false;
    }
}

std::string keepPath(const std::string& name, void*)
{
    return name;
}

// Keeps the encoded file of images with a URI; those in buffer views are read when a material wants
// them.
bool keepEncodedImage(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                      const unsigned char* bytes, int size, void*)
{
    if (image->bufferView < 0)
        image->image.assign(bytes, bytes + size);
    return true;
}

// The parser below copies "extras" by recursion: a file of a million brackets would end the stack.
void checkJsonDepth(const GltfDocument& document, std::span<const std::uint8_t> json)
{
    std::size_t depth = 0;
    bool inString = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = static_cast<char>(json[i]);
        if (inString) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                inString = false;
        } else if (c == '"') {
            inString = true;
        } else if (c == '[' || c == '{') {
            if (++depth > kMaximumJsonDepth)
                document.fail("JSON, byte " + std::to_string(i), "nested deeper than 64");
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
    }
}

std::uint32_t wordAt(std::span<const std::uint8_t> bytes, std::size_t offset)
{
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, 4); // glTF and all our hosts are little endian
    return word;
}

// Checks the container of a .glb and returns its JSON chunk.
std::span<const std::uint8_t> checkGlb(const GltfDocument& document,
                                       std::span<const std::uint8_t> bytes)
{
    const auto fail = [&](const std::string& reason) { document.fail("GLB header", reason); };
    if (bytes.size() < 20)
        fail("truncated: " + std::to_string(bytes.size()) + " bytes");
    if (wordAt(bytes, 4) != 2)
        fail("version " + std::to_string(wordAt(bytes, 4)) + ", only 2 is known");
    const std::uint64_t length = wordAt(bytes, 8);
    if (length > bytes.size())
        fail("truncated: " + std::to_string(length) + " bytes announced, the file has " +
             std::to_string(bytes.size()));
    const std::uint64_t jsonLength = wordAt(bytes, 12);
    const std::uint64_t jsonEnd = 20 + jsonLength;
    if (wordAt(bytes, 16) != 0x4E4F534Au)
        fail("the first chunk is not JSON");
    if (jsonEnd > length)
        fail("the JSON chunk of " + std::to_string(jsonLength) + " bytes does not fit the file");
    if (jsonEnd < length) {
        if (jsonEnd + 8 > length)
            fail("truncated: the second chunk has no header");
        const std::uint64_t binaryLength = wordAt(bytes, jsonEnd);
        if (jsonEnd + 8 + binaryLength > length)
            fail("the second chunk of " + std::to_string(binaryLength) +
                 " bytes does not fit the file");
    }
    return bytes.subspan(20, jsonLength);
}

std::string firstLine(const std::string& text)
{
    return text.substr(0, text.find('\n'));
}

// Extensions that change what the scene means and that we follow; any other required one is
// refused.
void checkRequiredExtensions(const GltfDocument& document)
{
    static const char* const kKnown[] = {"KHR_lights_punctual", "KHR_materials_emissive_strength",
                                         "KHR_materials_specular", "KHR_texture_transform"};
    for (const std::string& name : document.model.extensionsRequired) {
        if (std::find(std::begin(kKnown), std::end(kKnown), name) == std::end(kKnown))
            document.fail("extensionsRequired", "'" + name + "' is not supported");
    }
}

} // namespace

std::span<const unsigned char> GltfDocument::view(int index, const std::string& place) const
{
    const tinygltf::BufferView& view = at(model.bufferViews, index, "bufferView", place);
    const std::string name = "bufferView " + std::to_string(index);
    const tinygltf::Buffer& buffer = at(model.buffers, view.buffer, "buffer", name);
    const std::uint64_t size = buffer.data.size();
    if (view.byteOffset > size || view.byteLength > size - view.byteOffset)
        fail(name, "bytes " + std::to_string(view.byteOffset) + " + " +
                       std::to_string(view.byteLength) + " lie outside the buffer of " +
                       std::to_string(size));
    return std::span(buffer.data).subspan(view.byteOffset, view.byteLength);
}

float GltfDocument::readNumber(double value, const std::string& place) const
{
    const float result = static_cast<float>(value);
    if (!std::isfinite(result))
        fail(place, "a number is not finite");
    return result;
}

void GltfDocument::readNumbers(const std::vector<double>& numbers, std::span<float> out,
                               const std::string& place) const
{
    if (numbers.empty())
        return;
    if (numbers.size() != out.size())
        fail(place, std::to_string(numbers.size()) + " numbers where " +
                        std::to_string(out.size()) + " belong");
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = readNumber(numbers[i], place);
}

GltfDocument readGltfDocument(std::span<const std::uint8_t> bytes,
                              const std::filesystem::path& path)
{
    GltfDocument document;
    document.path = path;
    if (bytes.size() > kMaximumFileBytes)
        document.fail("", "larger than 2 GiB");
    const bool binary = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
    checkJsonDepth(document, binary ? checkGlb(document, bytes) : bytes);

    std::error_code ignored;
    const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : ".";
    AssetFiles files{std::filesystem::weakly_canonical(parent, ignored), ""};
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({assetFileExists, keepPath, readAssetFile, nullptr, &files});
    parser.SetImageLoader(keepEncodedImage, nullptr);
    std::string error;
    std::string warning;
    bool parsed = false;
    const auto size = static_cast<unsigned int>(bytes.size());
    try {
        if (binary)
            parsed = parser.LoadBinaryFromMemory(&document.model, &error, &warning, bytes.data(),
                                                 size, parent.string(), 0);
        else
            parsed = parser.LoadASCIIFromString(&document.model, &error, &warning,
                                                reinterpret_cast<const char*>(bytes.data()), size,
                                                parent.string(), 0);
    } catch (
        const std::exception& failure) { // nlohmann-json and std::vector throw through tinygltf
        document.fail("", failure.what());
    }
    if (!files.refused.empty())
        document.fail("uri '" + files.refused + "'", "lies outside the asset's directory");
    if (!parsed)
        document.fail("", error.empty() ? "not a glTF 2.0 file" : firstLine(error));
    if (!warning.empty())
        logDebug(path.string() + ": " + firstLine(warning));
    checkRequiredExtensions(document);
    return document;
}

} // namespace strandlight
