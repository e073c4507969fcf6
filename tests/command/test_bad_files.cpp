// Files that are missing, broken or hostile: exit code 1, one line that names the file, and no
// output. What exactly each reader refuses is tested beside it (tests/unit).
#include <doctest/doctest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "tests/command/run_command.hpp"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight::test;
using Bytes = std::vector<std::uint8_t>;

namespace {

Bytes bytesOf(const std::string& text)
{
    return {text.begin(), text.end()};
}

// Bakes a scene file and expects the refusal to name it; the folder then holds what it held before.
void checkBakeRefuses(const TemporaryFolder& folder, const std::filesystem::path& scene,
                      const std::string& part)
{
    const std::vector<std::string> before = listFolder(folder.path());
    const CommandResult result =
        runCommand({"bake", scene.string(), "-o", (folder.path() / "out.sgl").string(), "--json",
                    (folder.path() / "out.json").string()});
    checkFails(result, part);
    CHECK(result.errors.find(scene.filename().string()) != std::string::npos);
    CHECK(listFolder(folder.path()) == before);
}

void setFirstPosition(GltfMaker& maker, float value)
{
    const std::size_t view = maker.json["accessors"][0]["bufferView"];
    const std::size_t offset = maker.json["bufferViews"][view]["byteOffset"];
    std::memcpy(maker.binary.data() + offset, &value, sizeof value);
}

// A PNG whose header claims 60,000 x 60,000 pixels. The sides are at bytes 16 and 20.
Bytes hugePng()
{
    Bytes png = plainPng(2, 2);
    for (const std::size_t side : {std::size_t(16), std::size_t(20)}) {
        png[side + 2] = 60000 >> 8;
        png[side + 3] = 60000 & 255;
    }
    return png;
}

// A valid Radiance picture of one colour, flat (not run-length) pixels.
Bytes plainHdr(int width, int height)
{
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) +
                       " +X " + std::to_string(width) + "\n";
    for (int i = 0; i < width * height; ++i)
        text += "\x80\x80\x80\x81";
    return bytesOf(text);
}

} // namespace

TEST_CASE("scenes that are not there or not scenes")
{
    const TemporaryFolder folder;
    checkBakeRefuses(folder, folder.path() / "missing.gltf", "No such file");
    checkBakeRefuses(folder, folder.path(), "folder");
    checkBakeRefuses(folder, folder.write("text.gltf", bytesOf("not a scene\nat all\n")), "");
    checkBakeRefuses(folder, folder.write("empty.glb", {}), "");
    Bytes cut = quadGltf().glb();
    cut.resize(cut.size() / 2);
    checkBakeRefuses(folder, folder.write("cut.glb", cut), "");
}

TEST_CASE("scenes whose content cannot be used")
{
    struct Case
    {
        const char* name;
        const char* part;
        std::function<void(GltfMaker&)> apply;
    };
    const Case cases[] = {
        {"zero_triangles.glb", "triangles", [](GltfMaker& m) { m.json["nodes"][0].erase("mesh"); }},
        {"nan.glb", "not finite",
         [](GltfMaker& m) { setFirstPosition(m, std::numeric_limits<float>::quiet_NaN()); }},
        {"no_buffer.glb", "nowhere.bin",
         [](GltfMaker& m) { m.json["buffers"][0]["uri"] = "nowhere.bin"; }},
        {"no_texture.glb", "nowhere.png",
         [](GltfMaker& m) {
             m.json["images"][0] = {{"uri", "nowhere.png"}};
         }},
        {"no_uv.glb", "TEXCOORD_0",
         [](GltfMaker& m) {
             m.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
         }},
        {"huge_texture.glb", "60000",
         [](GltfMaker& m) {
             m.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] =
                 m.addTexture(hugePng(), "image/png");
         }},
    };
    const TemporaryFolder folder;
    for (const Case& broken : cases) {
        CAPTURE(broken.name);
        GltfMaker maker = quadGltf();
        broken.apply(maker);
        checkBakeRefuses(folder, folder.write(broken.name, maker.glb()), broken.part);
    }
}

TEST_CASE("a scene without texture coordinates gets charts of its own")
{
    GltfMaker maker = quadGltf();
    maker.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
    maker.json["materials"] = {{{"name", "plain"}}};
    const TemporaryFolder folder;
    const CommandResult result =
        runCommand({"info", folder.write("plain.glb", maker.glb()).string()});
    CAPTURE(result.errors);
    CHECK(result.exitCode == 0);
    CHECK(result.output.find("own charts: no TEXCOORD_1") != std::string::npos);
}

TEST_CASE("environments that cannot be used")
{
    const TemporaryFolder folder;
    Bytes cut = plainHdr(8, 4);
    cut.resize(cut.size() - 5);
    const std::filesystem::path files[] = {
        folder.path() / "missing.hdr",
        folder.write("text.hdr", bytesOf("no picture\n")),
        folder.write("cut.hdr", cut),
        folder.write("garbage.exr", bytesOf("v/1\x01 and then nothing that makes sense")),
        folder.write("huge.hdr", bytesOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X "
                                         "60000\n")),
    };
    const std::vector<std::string> before = listFolder(folder.path());
    for (const std::filesystem::path& file : files) {
        CAPTURE(file);
        checkFails(runCommand({"bake", "builtin:box", "--env", file.string(), "-o",
                               (folder.path() / "out.sgl").string()}),
                   file.filename().string());
    }
    CHECK(listFolder(folder.path()) == before);
}

TEST_CASE("bakes that cannot be used")
{
    const TemporaryFolder folder;
    const std::string good = (folder.path() / "good.sgl").string();
    const CommandResult baked =
        runCommand({"bake", "builtin:furnace", "-o", good, "--atlas", "16", "--spp", "1", "--steps",
                    "5", "--lobes", "2", "--lightfield", "4"});
    CAPTURE(baked.errors);
    REQUIRE(baked.exitCode == 0);

    Bytes cut = fileBytes(good), altered = cut;
    cut.resize(cut.size() - 7);
    altered[altered.size() / 2] ^= 1;
    const std::filesystem::path files[] = {
        folder.path() / "missing.sgl", folder.write("cut.sgl", cut),
        folder.write("altered.sgl", altered), folder.write("text.sgl", bytesOf("no bake"))};
    const std::vector<std::string> before = listFolder(folder.path());
    const std::string picture = (folder.path() / "out.png").string();
    for (const std::filesystem::path& file : files) {
        CAPTURE(file);
        const std::string name = file.filename().string();
        checkFails(
            runCommand({"render", "builtin:furnace", "--bake", file.string(), "-o", picture}),
            name);
        checkFails(runCommand({"info", file.string()}), name);
    }
    // A bake belongs to its scene.
    checkFails(runCommand({"render", "builtin:room", "--bake", good, "-o", picture}), "good.sgl");
    CHECK(listFolder(folder.path()) == before);
}

TEST_CASE("pictures and vectors that cannot be used")
{
    const TemporaryFolder folder;
    const std::string small = folder.write("small.png", plainPng(2, 2)).string();
    const std::string large = folder.write("large.png", plainPng(3, 2)).string();
    const std::string text = folder.write("text.png", bytesOf("no picture")).string();
    const std::string heat = (folder.path() / "heat.png").string();
    checkFails(
        runCommand({"compare", small, (folder.path() / "missing.png").string(), "--heatmap", heat}),
        "missing.png");
    checkFails(runCommand({"compare", small, text, "--heatmap", heat}), "text.png");
    checkFails(runCommand({"compare", small, large, "--heatmap", heat}), "3x2");
    CHECK(listFolder(folder.path()).size() == 3);

    const std::string vectors =
        folder.write("broken.safetensors", Bytes(12, std::uint8_t(255))).string();
    checkFails(runCommand({"nn", "check", vectors}), "broken.safetensors");
}
