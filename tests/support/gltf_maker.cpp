#include "tests/support/gltf_maker.hpp"

#include <atomic>
#include <cstring>
#include <string_view>

#include <unistd.h>

#include "engine/base/file.hpp"
#include "engine/base/image_io.hpp"

namespace strandlight::test {

namespace {

void appendWord(std::vector<std::uint8_t>& bytes, std::uint32_t word)
{
    for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

std::string base64(const std::vector<std::uint8_t>& bytes)
{
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text.push_back(i + k <= bytes.size() ? kDigits[(word >> (18 - 6 * k)) & 63u] : '=');
    }
    return text;
}

} // namespace

int GltfMaker::addView(const void* data, std::size_t bytes)
{
    const std::size_t offset = binary.size();
    binary.resize(offset + (bytes + 3) / 4 * 4);
    std::memcpy(binary.data() + offset, data, bytes);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}});
    json["buffers"][0]["byteLength"] = binary.size();
    return static_cast<int>(json["bufferViews"].size()) - 1;
}

int GltfMaker::addFloats(const std::vector<float>& values, int components)
{
    static constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    json["accessors"].push_back({{"bufferView", addView(values.data(), values.size() * 4)},
                                 {"componentType", 5126},
                                 {"count", values.size() / std::size_t(components)},
                                 {"type", kTypes[components]}});
    return static_cast<int>(json["accessors"].size()) - 1;
}

int GltfMaker::addIndices(const std::vector<std::uint16_t>& values)
{
    json["accessors"].push_back({{"bufferView", addView(values.data(), values.size() * 2)},
                                 {"componentType", 5123},
                                 {"count", values.size()},
                                 {"type", "SCALAR"}});
    return static_cast<int>(json["accessors"].size()) - 1;
}

int GltfMaker::addTexture(const std::vector<std::uint8_t>& encoded, const std::string& mimeType)
{
    json["images"].push_back(
        {{"bufferView", addView(encoded.data(), encoded.size())}, {"mimeType", mimeType}});
    json["textures"].push_back({{"source", json["images"].size() - 1}});
    return static_cast<int>(json["textures"].size()) - 1;
}

std::vector<std::uint8_t> GltfMaker::glb() const
{
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<std::uint8_t> bytes = {'g', 'l', 'T', 'F'};
    appendWord(bytes, 2);
    appendWord(bytes, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size()));
    appendWord(bytes, static_cast<std::uint32_t>(text.size()));
    appendWord(bytes, 0x4E4F534Au);
    bytes.insert(bytes.end(), text.begin(), text.end());
    appendWord(bytes, static_cast<std::uint32_t>(binary.size()));
    appendWord(bytes, 0x004E4942u);
    bytes.insert(bytes.end(), binary.begin(), binary.end());
    return bytes;
}

std::vector<std::uint8_t> GltfMaker::gltf(const std::string& bufferUri) const
{
    nlohmann::json copy = json;
    copy["buffers"][0]["uri"] =
        bufferUri.empty() ? "data:application/octet-stream;base64," + base64(binary) : bufferUri;
    const std::string text = copy.dump();
    return {text.begin(), text.end()};
}

GltfMaker quadGltf()
{
    GltfMaker maker;
    maker.json["asset"]["version"] = "2.0";
    maker.json["scene"] = 0;
    maker.json["scenes"] = {{{"nodes", {0}}}};
    maker.json["nodes"] = {{{"mesh", 0}}};
    const int position = maker.addFloats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3);
    const int normal = maker.addFloats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    const int uv = maker.addFloats({0, 1, 1, 1, 1, 0, 0, 0}, 2);
    const int indices = maker.addIndices({0, 1, 2, 0, 2, 3});
    const int texture = maker.addTexture(plainPng(2, 2), "image/png");
    maker.json["materials"] = {
        {{"name", "paint"},
         {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}}};
    maker.json["meshes"] = {
        {{"primitives",
          {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
            {"indices", indices},
            {"material", 0}}}}}};
    return maker;
}

std::vector<std::uint8_t> plainPng(std::uint32_t width, std::uint32_t height)
{
    return encodePng(CpuImage(width, height, glm::vec4(0.2f, 0.5f, 0.8f, 1.0f)));
}

TemporaryFolder::TemporaryFolder()
{
    static std::atomic<int> counter{0};
    path_ = std::filesystem::temp_directory_path() /
            ("strandlight_test_" + std::to_string(getpid()) + "_" + std::to_string(counter++));
    std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::write(const std::string& name,
                                             const std::vector<std::uint8_t>& bytes) const
{
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    writeFileAtomically(file, bytes);
    return file;
}

} // namespace strandlight::test
