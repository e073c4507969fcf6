// Bakes through the command: the same bytes whatever the threads, and after an interruption; then
// a picture from one.
#include <doctest/doctest.h>

#include "tests/command/run_command.hpp"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight::test;

namespace {

using Words = std::vector<std::string>;

Words operator+(Words left, const Words& right)
{
    left.insert(left.end(), right.begin(), right.end());
    return left;
}

Words bakeRoom(const std::string& output, const Words& settings)
{
    return Words{"bake", "builtin:room", "-o", output} + settings;
}

const Words kTiny{"--atlas", "16", "--lightfield", "8", "--spp", "2", "--steps", "40"};

// Of the line "  at once, at most   1.23 MiB"; 0 without it.
double plannedMebibytes(const std::string& output)
{
    const std::string label = "at once, at most";
    const std::size_t at = output.find(label);
    return at == std::string::npos ? 0.0 : std::stod(output.substr(at + label.size()));
}

// Interrupts a bake after ever shorter times until one is caught at work; true when one was.
bool interruptBake(const std::string& output, const Words& settings)
{
    for (const int after : {700, 350, 180, 90, 45}) {
        CommandOptions options;
        options.interruptAfterMilliseconds = after;
        const CommandResult result = runCommand(bakeRoom(output, settings), options);
        CAPTURE(result.errors);
        if (result.exitCode == 0) {
            std::filesystem::remove(output); // it was faster
            continue;
        }
        CHECK(result.exitCode == 130);
        CHECK(result.errors.ends_with("interrupted\n"));
        CHECK(!std::filesystem::exists(output));
        if (std::filesystem::exists(output + ".checkpoint"))
            return true; // else it was still loading
    }
    return false;
}

void checkResume(const Words& settings)
{
    const TemporaryFolder folder;
    const std::string whole = (folder.path() / "whole.sgl").string();
    const std::string resumed = (folder.path() / "resumed.sgl").string();
    REQUIRE(runCommand(bakeRoom(whole, settings)).exitCode == 0);
    if (!interruptBake(resumed, settings)) {
        MESSAGE("no interruption met a bake at work: this device is too fast for these settings");
        return;
    }
    const CommandResult result = runCommand(bakeRoom(resumed, settings + Words{"--resume"}));
    CAPTURE(result.errors);
    CHECK(result.exitCode == 0);
    CHECK(fileBytes(resumed) == fileBytes(whole));
    CHECK(listFolder(folder.path()) == Words{"resumed.sgl", "whole.sgl"}); // no checkpoint left
}

} // namespace

TEST_CASE("the same bake gives the same bytes at one and two threads")
{
    const TemporaryFolder folder;
    std::vector<std::vector<std::uint8_t>> files;
    for (const char* threads : {"1", "2", "2"}) {
        const std::string output = (folder.path() / "room.sgl").string();
        CommandOptions options;
        options.environment = {std::string("LP_NUM_THREADS=") + threads};
        const CommandResult result = runCommand(bakeRoom(output, kTiny), options);
        CAPTURE(result.errors);
        REQUIRE(result.exitCode == 0);
        files.push_back(fileBytes(output));
    }
    CHECK(files[0].size() > 1000);
    CHECK(files[0] == files[1]);
    CHECK(files[1] == files[2]);
}

TEST_CASE("another seed gives another bake")
{
    const TemporaryFolder folder;
    const std::string first = (folder.path() / "1.sgl").string();
    const std::string second = (folder.path() / "2.sgl").string();
    REQUIRE(runCommand(bakeRoom(first, kTiny + Words{"--seed", "1"})).exitCode == 0);
    REQUIRE(runCommand(bakeRoom(second, kTiny + Words{"--seed", "2"})).exitCode == 0);
    CHECK(fileBytes(first) != fileBytes(second));
}

TEST_CASE("a bake interrupted during capture resumes to the same bytes")
{
    checkResume({"--atlas", "24", "--lightfield", "8", "--spp", "40", "--steps", "20"});
}

TEST_CASE("a bake interrupted during the fit resumes to the same bytes")
{
    checkResume({"--atlas", "24", "--lightfield", "8", "--spp", "1", "--steps", "2500"});
}

TEST_CASE("an interrupted picture is not written")
{
    const TemporaryFolder folder;
    const std::string picture = (folder.path() / "box.png").string();
    CommandOptions options;
    options.interruptAfterMilliseconds = 500;
    const CommandResult result = runCommand(
        {"reference", "builtin:room", "-o", picture, "--size", "640x480", "--spp", "1000000"},
        options);
    CHECK(result.exitCode == 130);
    CHECK(result.errors.ends_with("interrupted\n"));
    CHECK(listFolder(folder.path()).empty());
}

TEST_CASE("a checkpoint of other settings is refused")
{
    const TemporaryFolder folder;
    const std::string output = (folder.path() / "room.sgl").string();
    const Words settings{"--atlas", "24", "--lightfield", "8", "--spp", "40", "--steps", "20"};
    if (!interruptBake(output, settings)) {
        MESSAGE("no interruption met a bake at work: this device is too fast for these settings");
        return;
    }
    checkFails(runCommand(bakeRoom(output, settings + Words{"--seed", "7", "--resume"})),
               "room.sgl.checkpoint");
    CHECK(!std::filesystem::exists(output));
    CHECK(std::filesystem::exists(output + ".checkpoint")); // hours of work may be in it
}

TEST_CASE("an empty scene bakes to a valid file and renders, without touching the device")
{
    const TemporaryFolder folder;
    const auto in = [&](const char* name) { return (folder.path() / name).string(); };
    REQUIRE(
        runCommand({"bake", "builtin:empty", "-o", in("e.sgl"), "--json", in("b.json")}).exitCode ==
        0);
    const nlohmann::json baked = readJson(in("b.json"))["result"];
    CHECK(baked["texels"] == 0);
    CHECK(baked["capture_dispatches"] == 0);
    CHECK(baked["peak_device_bytes"] == 0);
    CHECK(baked["savings"]["lobes"] == 0);
    CHECK(runCommand({"info", in("e.sgl")}).exitCode == 0);
    REQUIRE(runCommand({"render", "builtin:empty", "--bake", in("e.sgl"), "-o", in("e.png"),
                        "--size", "32x24", "--stats", "--json", in("r.json")})
                .exitCode == 0);
    const nlohmann::json rendered = readJson(in("r.json"))["result"];
    CHECK(rendered["passes"].empty());
    CHECK(rendered["peak_device_bytes"] == 0);
    CHECK(rendered["skipped"].size() == 2);
    checkFails(runCommand({"render", "builtin:room", "--bake", in("e.sgl"), "-o", in("x.png")}),
               "other geometry");
}

TEST_CASE("render --stats tells what dropped lobes save, and nothing of them where none were")
{
    const TemporaryFolder folder;
    const auto in = [&](const char* name) { return (folder.path() / name).string(); };
    const auto stats = [&](const Words& options) {
        REQUIRE(runCommand(bakeRoom(in("room.sgl"), kTiny + options)).exitCode == 0);
        const CommandResult result =
            runCommand({"render", "builtin:room", "--bake", in("room.sgl"), "-o", in("a.png"),
                        "--size", "32x24", "--stats", "--json", in("r.json")});
        REQUIRE(result.exitCode == 0);
        return result.output;
    };
    CHECK(stats({"--lobe-error", "0"}).find("dropped") == std::string::npos);
    CHECK(stats({"--lobe-error", "0.05"}).find("turns of a pass's loop") != std::string::npos);
    const nlohmann::json result = readJson(in("r.json"))["result"];
    // All eight of every pixel that is seen, four to a pixel of the picture.
    CHECK(result["lobe_trips_with_all_lobes"] == 8 * 4 * 32 * 24);
    CHECK(result["lobe_trips"] < result["lobe_trips_with_all_lobes"]);
    CHECK(result["lobe_trips"] > 0);
    CHECK(result["savings"]["kept_lobes"] < result["savings"]["lobes"]);
}

TEST_CASE("bake, info, render and reference, each with JSON")
{
    const TemporaryFolder folder;
    const auto in = [&](const char* name) { return (folder.path() / name).string(); };
    const auto run = [&](const Words& arguments, const char* json) {
        const CommandResult result = runCommand(arguments + Words{"--json", in(json)});
        CAPTURE(arguments[0]);
        CAPTURE(result.errors);
        REQUIRE(result.exitCode == 0);
        const nlohmann::json written = readJson(in(json));
        CHECK(written["command"] == arguments[0]);
        return written;
    };
    const nlohmann::json baked = run(bakeRoom(in("room.sgl"), kTiny), "bake.json");
    CHECK(baked["settings"]["atlas"] == 16);
    CHECK(baked["result"]["file_bytes"] == std::filesystem::file_size(in("room.sgl")));
    // The plan, printed to a hundredth of a MiB, is what was allocated, but for staging where the
    // host does not see the device's memory: that is at most as much again.
    const double planned =
        plannedMebibytes(runCommand(bakeRoom(in("none.sgl"), kTiny + Words{"--memory"})).output);
    const double peak = baked["result"]["peak_device_bytes"].get<double>() / 1048576.0;
    CHECK(planned < peak + 0.01);
    CHECK(planned > 0.5 * peak);
    CHECK_FALSE(std::filesystem::exists(in("none.sgl")));

    const nlohmann::json info = run({"info", in("room.sgl")}, "info.json");
    CHECK(info["bake"]["texels"] == baked["result"]["texels"]);
    CHECK(info["bake"]["lobes"] == 8);
    CHECK(run({"info", "builtin:room"}, "scene.json")["scene"]["triangles"] > 100);
    CHECK(run({"info"}, "devices.json")["devices"].size() > 0);

    const nlohmann::json rendered =
        run({"render", "builtin:room", "--bake", in("room.sgl"), "-o", in("a.exr"), "-o",
             in("a.png"), "--size", "32x24", "--stats"},
            "render.json");
    CHECK(rendered["result"]["passes"].size() >= 3);
    CHECK(rendered["result"]["skipped"].size() > 0); // the room has no environment
    run({"reference", "builtin:room", "-o", in("b.exr"), "--size", "32x24", "--spp", "4"},
        "truth.json");
    run({"compare", in("a.exr"), in("b.exr"), "--heatmap", in("heat.png")}, "compare.json");
    run({"report", "--render", in("a.exr"), "--reference", in("b.exr"), "--results",
         in("bake.json"), in("render.json"), in("truth.json"), "-o", in("report.html")},
        "report.json");
    for (const char* name : {"a.exr", "a.png", "heat.png", "report.html"})
        CHECK(std::filesystem::file_size(in(name)) > 100);
}
