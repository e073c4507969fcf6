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
    checkFails(runCommand({"hair", "-o", none}), "");
    CHECK(fileBytes(none).empty());
}
