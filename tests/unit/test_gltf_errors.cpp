// Broken glTF files: one clear error each, and never a crash.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <string>

#include "engine/base/error.hpp"
#include "engine/base/log.hpp"
#include "engine/scene/gltf_loader.hpp"
#include "engine/scene/scene_loader.hpp"
#include "shaders/shared/rng.h"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight;
using nlohmann::json;
using test::GltfMaker;
using test::quadGltf;

namespace {

// The error of loading, or "" when there is none. Any exception but FileError fails the test by
// leaving it.
std::string errorOf(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path)
{
    try {
        parseGltf(bytes, path);
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

void checkError(const std::string& error, const std::string& part)
{
    CAPTURE(error);
    CAPTURE(part);
    CHECK(error.find(part) != std::string::npos);
    CHECK(error.find("memory.glb") != std::string::npos); // names the file
    CHECK(error.find('\n') == std::string::npos);         // is one line
}

struct Breakage
{
    const char* what;
    const char* message; // part of the error
    std::function<void(GltfMaker&)> apply;
};

json& primitive(GltfMaker& maker)
{
    return maker.json["meshes"][0]["primitives"][0];
}

void setBinaryFloat(GltfMaker& maker, std::size_t accessor, std::size_t element, float value)
{
    const std::size_t view = maker.json["accessors"][accessor]["bufferView"];
    const std::size_t offset = maker.json["bufferViews"][view]["byteOffset"];
    std::memcpy(maker.binary.data() + offset + 4 * element, &value, 4);
}

void useTexture(GltfMaker& maker, const std::vector<std::uint8_t>& encoded)
{
    maker.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] =
        maker.addTexture(encoded, "image/png");
}

std::vector<std::uint8_t> hugePng()
{
    std::vector<std::uint8_t> png = test::plainPng(2, 2);
    for (const std::size_t side : {std::size_t(16), std::size_t(20)}) {
        png[side] = 0;
        png[side + 1] = 0;
        png[side + 2] = 60000 >> 8;
        png[side + 3] = 60000 & 255;
    }
    return png;
}

constexpr double kHuge = 18446744073709551615.0;

const Breakage kBreakages[] = {
    {"zero triangles", "no triangles", [](GltfMaker& m) { m.json["nodes"][0].erase("mesh"); }},
    {"all triangles degenerate", "no triangles",
     [](GltfMaker& m) {
         primitive(m)["indices"] = m.addIndices({0, 0, 1, 2, 2, 2});
     }},
    {"NaN position", "not finite",
     [](GltfMaker& m) { setBinaryFloat(m, 0, 4, std::numeric_limits<float>::quiet_NaN()); }},
    {"infinite normal", "not finite",
     [](GltfMaker& m) { setBinaryFloat(m, 1, 0, std::numeric_limits<float>::infinity()); }},
    {"position that overflows when scaled", "not finite",
     [](GltfMaker& m) {
         m.json["nodes"][0]["scale"] = {1e39, 1, 1};
     }},
    {"index out of range", "index 7 of 4",
     [](GltfMaker& m) {
         primitive(m)["indices"] = m.addIndices({0, 1, 7});
     }},
    {"corners that make no triangles", "do not make triangles",
     [](GltfMaker& m) {
         primitive(m)["indices"] = m.addIndices({0, 1, 2, 3});
     }},
    {"count beyond the view", "do not fit",
     [](GltfMaker& m) { m.json["accessors"][0]["count"] = 5; }},
    {"count that wraps when multiplied", "do not fit",
     [](GltfMaker& m) { m.json["accessors"][1]["count"] = 0x1555555555555556u; }},
    {"offset near 2^64", "do not fit",
     [](GltfMaker& m) { m.json["accessors"][0]["byteOffset"] = 0xfffffffffffffff0u; }},
    {"view beyond the buffer", "outside the buffer",
     [](GltfMaker& m) { m.json["bufferViews"][0]["byteOffset"] = 1u << 30; }},
    {"view whose end wraps", "outside the buffer",
     [](GltfMaker& m) { m.json["bufferViews"][0]["byteLength"] = 0xffffffffffffffffu; }},
    {"stride below the element", "stride",
     [](GltfMaker& m) { m.json["bufferViews"][0]["byteStride"] = 8; }},
    {"stride above 252", "byteStride",
     [](GltfMaker& m) { m.json["bufferViews"][0]["byteStride"] = 256; }},
    {"accessor that does not exist", "accessor 99",
     [](GltfMaker& m) { primitive(m)["attributes"]["POSITION"] = 99; }},
    {"negative accessor", "accessor -3",
     [](GltfMaker& m) { primitive(m)["attributes"]["POSITION"] = -3; }},
    {"accessor without its view", "bufferView 99",
     [](GltfMaker& m) { m.json["accessors"][0]["bufferView"] = 99; }},
    {"a billion zeros", "the scene exceeds",
     [](GltfMaker& m) {
         m.json["accessors"][0].erase("bufferView");
         m.json["accessors"][0]["count"] = 1000000000;
     }},
    {"wrong accessor type", "3 components",
     [](GltfMaker& m) { m.json["accessors"][0]["type"] = "VEC2"; }},
    {"fewer normals than positions", "elements for 4 vertices",
     [](GltfMaker& m) { m.json["accessors"][1]["count"] = 3; }},
    {"float indices", "component type",
     [](GltfMaker& m) {
         primitive(m)["indices"] = m.addFloats({0, 1, 2}, 1);
     }},
    {"sparse index out of range", "sparse index",
     [](GltfMaker& m) {
         const int index = m.addIndices({9});
         m.json["accessors"][0]["sparse"] = {
             {"count", 1},
             {"indices",
              {{"bufferView", m.json["accessors"][index]["bufferView"]}, {"componentType", 5123}}},
             {"values", {{"bufferView", 0}}}};
     }},
    {"negative sparse count", "sparse",
     [](GltfMaker& m) {
         m.json["accessors"][0]["sparse"] = {
             {"count", -1},
             {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
             {"values", {{"bufferView", 0}}}};
     }},
    {"node cycle", "reached twice", [](GltfMaker& m) { m.json["nodes"][0]["children"] = {0}; }},
    {"deep nodes", "nested deeper",
     [](GltfMaker& m) {
         for (int i = 0; i < 100; ++i)
             m.json["nodes"][std::size_t(i)]["children"] = {i + 1};
         m.json["nodes"][100] = {{"mesh", 0}};
     }},
    {"child that does not exist", "node 5",
     [](GltfMaker& m) { m.json["nodes"][0]["children"] = {5}; }},
    {"scene that does not exist", "scene 3", [](GltfMaker& m) { m.json["scene"] = 3; }},
    {"rotation of zero", "quaternion",
     [](GltfMaker& m) {
         m.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
     }},
    {"perspective matrix", "affine",
     [](GltfMaker& m) {
         m.json["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
     }},
    {"unknown required extension", "'KHR_draco_mesh_compression' is not supported",
     [](GltfMaker& m) { m.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }},
    {"material that does not exist", "material 4",
     [](GltfMaker& m) { primitive(m)["material"] = 4; }},
    {"texture that does not exist", "texture 4",
     [](GltfMaker& m) {
         m.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 4;
     }},
    {"image that does not exist", "image 4",
     [](GltfMaker& m) { m.json["textures"][0]["source"] = 4; }},
    {"missing texture file", "missing",
     [](GltfMaker& m) {
         m.json["images"][0] = {{"uri", "nowhere.png"}};
     }},
    {"missing buffer file", "nowhere.bin",
     [](GltfMaker& m) { m.json["buffers"][0]["uri"] = "nowhere.bin"; }},
    {"buffer outside the directory", "outside the asset's directory",
     [](GltfMaker& m) { m.json["buffers"][0]["uri"] = "../../../../../../etc/passwd"; }},
    {"buffer by absolute path", "not found",
     [](GltfMaker& m) { m.json["buffers"][0]["uri"] = "/etc/passwd"; }},
    {"texture of 60,000 x 60,000", "60000 x 60000", [](GltfMaker& m) { useTexture(m, hugePng()); }},
    {"truncated PNG", "picture",
     [](GltfMaker& m) {
         std::vector<std::uint8_t> png = test::plainPng(64, 64);
         png.resize(png.size() / 2);
         useTexture(m, png);
     }},
    {"a picture of another format", "neither PNG nor JPEG",
     [](GltfMaker& m) {
         useTexture(m, {'G', 'I', 'F', '8', '9', 'a', 0, 0});
     }},
    {"emission that overflows", "not finite",
     [](GltfMaker& m) {
         m.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
         m.json["materials"][0]["extensions"]["KHR_materials_emissive_strength"]
               ["emissiveStrength"] = 1e300;
     }},
    {"factor outside its range", "outside [0, 1]",
     [](GltfMaker& m) { m.json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = -2; }},
    {"third texture coordinate set", "other than 0 and 1",
     [](GltfMaker& m) {
         m.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 2;
     }},
    {"camera without a view", "yfov",
     [](GltfMaker& m) {
         m.json["cameras"] = {
             {{"type", "perspective"}, {"perspective", {{"yfov", 4.0}, {"znear", 1}}}}};
         m.json["nodes"][0]["camera"] = 0;
     }},
    {"light that does not exist", "light 2",
     [](GltfMaker& m) { m.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 2; }},
    {"light number beyond int", "light -1",
     [](GltfMaker& m) {
         m.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = kHuge;
     }},
    {"extras nested without end", "nested deeper",
     [](GltfMaker& m) {
         json deep = 1;
         for (int i = 0; i < 200; ++i)
             deep = json::array({deep});
         m.json["extras"] = deep;
     }},
};

} // namespace

TEST_CASE("each kind of broken file has one clear error")
{
    REQUIRE(errorOf(quadGltf().glb(), "memory.glb").empty()); // the unbroken one loads
    for (const Breakage& breakage : kBreakages) {
        CAPTURE(breakage.what);
        GltfMaker maker = quadGltf();
        breakage.apply(maker);
        checkError(errorOf(maker.glb(), "memory.glb"), breakage.message);
    }
}

TEST_CASE("broken containers")
{
    const std::vector<std::uint8_t> good = quadGltf().glb();
    for (std::size_t size = 0; size < good.size(); size += size < 32 ? 1 : 61) {
        const std::vector<std::uint8_t> cut(good.begin(), good.begin() + std::ptrdiff_t(size));
        checkError(errorOf(cut, "memory.glb"), size >= 4 ? "truncated" : "");
    }
    std::vector<std::uint8_t> bytes = good;
    bytes[12] = 0xff;
    bytes[15] = 0xff;
    checkError(errorOf(bytes, "memory.glb"), "JSON chunk");
    const std::string text = "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [";
    checkError(errorOf({text.begin(), text.end()}, "memory.glb"), "parse error");
    CHECK_THROWS_AS(loadScene("no/such/file.glb"), FileError);
    CHECK_THROWS_AS(loadScene("builtin:nothing"), Error);
    CHECK_THROWS_AS(loadScene("builtin:furnace:1.5"), Error);
    CHECK_THROWS_AS(loadScene("builtin:furnace:nan"), Error);
    CHECK_THROWS_AS(loadScene("builtin:furnace:0.5x"), Error);
}

TEST_CASE("points and lines are skipped with a warning")
{
    GltfMaker maker = quadGltf();
    json line = primitive(maker);
    line["mode"] = 1;
    maker.json["meshes"][0]["primitives"].push_back(line);
    int warnings = 0;
    const LogSink previous = setLogSink([&](LogLevel level, const std::string&) {
        warnings += level == LogLevel::Warning ? 1 : 0;
    });
    const Scene scene = parseGltf(maker.glb(), "memory.glb");
    setLogSink(previous);
    CHECK(scene.triangles.size() == 2);
    CHECK(warnings == 1);
}

TEST_CASE("mutated files are loaded or refused, never worse")
{
    const LogSink previous = setLogSink([](LogLevel, const std::string&) {});
    const std::vector<std::uint8_t> seeds[] = {quadGltf().glb(), quadGltf().gltf()};
    int refused = 0;
    constexpr std::uint32_t kRounds = 600;
    for (std::uint32_t round = 0; round < kRounds; ++round) {
        std::vector<std::uint8_t> bytes = seeds[round % 2];
        const std::uint32_t edits = 1 + gpu::hashPcg(round) % 3;
        for (std::uint32_t edit = 0; edit < edits; ++edit) {
            const glm::uvec3 h = gpu::hashPcg3(glm::uvec3(round, edit, 7));
            const std::size_t at = h.x % bytes.size();
            switch (h.y % 10) {
            case 0: // any byte
                bytes[at] = static_cast<std::uint8_t>(h.z);
                break;
            case 1: // one bit
                bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1u << (h.z % 8)));
                break;
            case 3: // cut
                bytes.resize(std::max<std::size_t>(at, 1));
                break;
            case 2: // repeat a piece in place of another
                for (std::size_t i = 0; i < 8 && at + i < bytes.size(); ++i)
                    bytes[at + i] = bytes[(h.z + i) % bytes.size()];
                break;
            default: // a digit, where one stands: numbers of the JSON change, its form does not
                for (std::size_t i = 0; i < bytes.size(); ++i) {
                    std::uint8_t& c = bytes[(at + i) % bytes.size()];
                    if (c >= '0' && c <= '9') {
                        c = static_cast<std::uint8_t>('0' + h.z % 10);
                        break;
                    }
                }
            }
        }
        try {
            const Scene scene = parseGltf(bytes, "memory.glb");
            for (const glm::uvec3& t : scene.triangles)
                REQUIRE(std::max({t.x, t.y, t.z}) < scene.vertices.size());
        } catch (const Error&) {
            ++refused;
        }
    }
    setLogSink(previous);
    MESSAGE(refused << " of " << kRounds << " mutated files refused");
    CHECK(refused > int(kRounds) / 4); // the mutator does break things
    CHECK(refused < int(kRounds));     // and not everything it touches
}
