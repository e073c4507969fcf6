// Pictures of hair as a user makes them, and what the command refuses.
#include <algorithm>
#include <cstring>

#include <doctest/doctest.h>

#include "engine/base/image_io.hpp"
#include "tests/command/run_command.hpp"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

std::vector<std::string> render(const std::string& output, const std::vector<std::string>& more)
{
    std::vector<std::string> arguments = {
        "hair", "render", "builtin:short", "--strands", "600", "--size", "48x32", "-o", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

double meanDifference(const CpuImage& a, const CpuImage& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        sum += glm::length(glm::vec3(a.pixels[i] - b.pixels[i]));
    return sum / double(a.pixels.size());
}

} // namespace

TEST_CASE("hair render twice gives the same bytes, and another frame other noise")
{
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder.path() / name).string(); };
    const CommandResult first =
        runCommand(render(path("a.exr"), {"--json", path("a.json"), "--stats"}));
    CAPTURE(first.errors);
    REQUIRE(first.exitCode == 0);
    REQUIRE(runCommand(render(path("b.exr"), {})).exitCode == 0);
    REQUIRE(runCommand(render(path("c.exr"), {"--frame", "1"})).exitCode == 0);
    CHECK(fileBytes(path("a.exr")) == fileBytes(path("b.exr")));
    CHECK(fileBytes(path("a.exr")) != fileBytes(path("c.exr")));

    const nlohmann::json json = readJson(path("a.json"));
    CHECK(json["command"] == "hair render");
    CHECK(json["settings"]["strands"] == 600);
    CHECK(json["result"]["drawn_strands"].get<int>() <= 600);
    CHECK_FALSE(json["result"]["passes"].empty());
    CHECK(first.output.find("pass ") != std::string::npos);
    CHECK(fileBytes(path("a.json")).size() > 0);
}

TEST_CASE("filtered by the built-in network at a real size, twice the same bytes; tiles are told")
{
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder.path() / name).string(); };
    const auto filtered = [&](const std::string& output, const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"hair", "render", "builtin:wavy", "--strands",
                                              "2000", "--size", "640x384",      "--filter",
                                              "unet", "-o",     output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runCommand(arguments);
    };
    const CommandResult first = filtered(path("a.exr"), {"--stats", "--json", path("a.json")});
    CAPTURE(first.errors);
    REQUIRE(first.exitCode == 0);
    REQUIRE(filtered(path("b.exr"), {}).exitCode == 0);
    CHECK(fileBytes(path("a.exr")) == fileBytes(path("b.exr")));

    CHECK(first.output.find("tiles     out") != std::string::npos);
    CHECK(first.output.find("of 3840, ") != std::string::npos); // 80 x 48
    CHECK(first.output.find("saved ") != std::string::npos);
    const nlohmann::json tiles = readJson(path("a.json"))["result"]["tiles"];
    REQUIRE(tiles.size() == 7); // three down, three up, out
    for (const nlohmann::json& layer : tiles) {
        CHECK(layer["active"] > 0);
        CHECK(layer["active"] < layer["all"]);
    }
}

TEST_CASE("more samples come nearer to the reference")
{
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder.path() / name).string(); };
    REQUIRE(runCommand(render(path("few.exr"), {"--lod", "1"})).exitCode == 0);
    REQUIRE(runCommand(render(path("many.exr"), {"--lod", "1", "--samples", "64"})).exitCode == 0);
    const CommandResult truth =
        runCommand({"hair", "reference", "builtin:short", "--strands", "600", "--size", "48x32",
                    "--spp", "256", "-o", path("truth.exr")});
    CAPTURE(truth.errors);
    REQUIRE(truth.exitCode == 0);
    const CpuImage reference = loadImage(path("truth.exr"));
    const double few = meanDifference(loadImage(path("few.exr")), reference);
    const double many = meanDifference(loadImage(path("many.exr")), reference);
    CAPTURE(few);
    CAPTURE(many);
    // 16 times the samples: a quarter of the noise, and what widening to a pixel leaves as bias.
    CHECK(many < 0.7 * few);
}

TEST_CASE("hair of a file is drawn, and its broken forms are refused before any work")
{
    const TemporaryFolder folder;
    const std::string output = (folder.path() / "out.png").string();
    std::vector<std::uint8_t> bytes(128 + 24, 0); // one strand of two points
    const auto put = [&](std::size_t at, auto value) {
        std::memcpy(&bytes[at], &value, sizeof(value));
    };
    std::memcpy(bytes.data(), "HAIR", 4);
    put(4, 1u);
    put(8, 2u);
    put(12, 2u);
    put(16, 1u);
    put(20, 0.05f);
    put(28, 0.5f);
    put(128 + 16, 1.0f); // up
    const std::string hair = folder.write("one.hair", bytes).string();
    const CommandResult drawn =
        runCommand({"hair", "render", hair, "-o", output, "--size", "32x32"});
    CAPTURE(drawn.errors);
    REQUIRE(drawn.exitCode == 0);
    const CpuImage image = loadImage(output);
    const auto differs = [&](const glm::vec4& p) { return p != image.pixels[0]; };
    CHECK(std::any_of(image.pixels.begin(), image.pixels.end(), differs));

    const std::string none = (folder.path() / "none.png").string();
    put(8, 3u);
    const std::string broken = folder.write("broken.hair", bytes).string();
    checkFails(runCommand({"hair", "render", broken, "-o", none}), "do not have 3 points");
    checkFails(runCommand({"hair", "render", hair, "-o", none, "--frizz", "0.1"}), "--frizz");
    checkFails(runCommand({"hair", "render", "builtin:mullet", "-o", none}), "is not a groom");
    checkFails(runCommand({"hair", "render", hair, "-o", none, "--samples", "6"}), "multiple of 4");
    checkFails(runCommand({"hair", "render", hair, "-o", none, "--lod", "0"}), "--lod");
    checkFails(runCommand({"hair", "render", hair, "-o", "none.jpg"}), ".jpg");
    checkFails(runCommand(render(none, {"--filter", "unet", "--samples", "8"})), "four samples");
    checkFails(runCommand(render(none, {"--weights", "x.safetensors"})), "--filter unet");
    checkFails(runCommand(render(none, {"--precision", "fp16"})), "--filter unet");
    checkFails(runCommand(render(none, {"--precision", "fp8"})), "--precision");
    checkFails(runCommand(render(none, {"--fuse-fetch", "on"})), "--filter unet");
    checkFails(runCommand(render(none, {"--filter", "unet", "--weights", "x.safetensors"})),
               "x.safetensors");
    checkFails(runCommand({"hair", "-o", none}), "");
    CHECK(fileBytes(none).empty());
}

TEST_CASE("hair in a baked scene: lit by the bake, before its picture; errors are one line")
{
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder.path() / name).string(); };
    const std::string none = path("none.png");
    checkFails(runCommand(render(none, {"--bake", "x.sgl"})), "--scene");
    checkFails(runCommand(render(none, {"--hair-offset", "1,2"})), "X,Y,Z");
    checkFails(runCommand(render(none, {"--env", path("no.hdr")})), "no.hdr");
    const CommandResult bake =
        runCommand({"bake", "builtin:furnace:0.5", "-o", path("f.sgl"), "--atlas", "16",
                    "--lightfield", "8", "--spp", "2", "--steps", "40"});
    CAPTURE(bake.errors);
    REQUIRE(bake.exitCode == 0);
    checkFails(runCommand(render(none, {"--scene", "builtin:box", "--bake", path("f.sgl")})),
               "other geometry");
    CHECK(fileBytes(none).empty());

    // Within the furnace all is as bright as 1 / (1 - 0.5), and no lamp is needed.
    const CommandResult drawn = runCommand(
        render(path("in.exr"), {"--scene", "builtin:furnace:0.5", "--bake", path("f.sgl"),
                                "--hair-scale", "0.5", "--hair-offset", "0.1,0,0", "--camera",
                                "0.1,0,0.6,0.1,0,0", "--width", "10", "--json", path("in.json")}));
    CAPTURE(drawn.errors);
    REQUIRE(drawn.exitCode == 0);
    const CpuImage picture = loadImage(path("in.exr"));
    CHECK(picture.at(0, 0).x == doctest::Approx(2.0).epsilon(0.05));
    float darkest = 2.0f;
    for (const glm::vec4& pixel : picture.pixels)
        darkest = std::min(darkest, pixel.x);
    CHECK(darkest > 0.15f); // brown hair in bright light from everywhere
    CHECK(darkest < 1.8f);
    const nlohmann::json result = readJson(path("in.json"))["result"];
    std::string passes;
    for (const auto& pass : result["passes"])
        passes += pass["name"].get<std::string>() + ";";
    CHECK(passes.find("sg diffuse") != std::string::npos);
    CHECK(passes.find("hair lobes") != std::string::npos);
    CHECK(passes.find("hair shading 0") == std::string::npos);
}
