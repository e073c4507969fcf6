// strandlight hair train as a user calls it, in a size that takes seconds.
#include <algorithm>
#include <iterator>
#include <sstream>

#include <doctest/doctest.h>

#include "compute_nn/safetensors.hpp"
#include "tests/command/run_command.hpp"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

std::vector<std::string> train(const TemporaryFolder& folder, const std::string& output,
                               const std::vector<std::string>& more = {})
{
    std::vector<std::string> arguments = {"hair",
                                          "train",
                                          "--data",
                                          (folder.path() / "frames").string(),
                                          "-o",
                                          (folder.path() / output).string(),
                                          "--frames",
                                          "1",
                                          "--held-out",
                                          "1",
                                          "--frame-size",
                                          "32",
                                          "--target-spp",
                                          "8",
                                          "--steps",
                                          "3",
                                          "--batch",
                                          "1",
                                          "--crop",
                                          "16",
                                          "--net",
                                          "small",
                                          "--strand-share",
                                          "0.02"};
    for (std::size_t i = 0; i + 1 < more.size(); i += 2) { // in place of the value above, or anew
        const auto given = std::find(arguments.begin(), arguments.end(), more[i]);
        if (given != arguments.end())
            *(given + 1) = more[i + 1];
        else
            arguments.insert(arguments.end(), {more[i], more[i + 1]});
    }
    return arguments;
}

} // namespace

TEST_CASE("hair train writes weights, curve and log, and the same again")
{
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder.path() / name).string(); };
    const CommandResult first =
        runCommand(train(folder, "a.safetensors",
                         {"--curve", path("loss.svg"), "--json", path("log.json"), "--pictures",
                          folder.path().string()}));
    CAPTURE(first.errors);
    REQUIRE(first.exitCode == 0);
    CHECK(first.output.find("network/4") != std::string::npos);
    const Safetensors weights = Safetensors::load(path("a.safetensors"));
    CHECK(weights.has("enc1.weight"));
    CHECK(weights.metadata.at("command").find("--net small --steps 3") != std::string::npos);
    const nlohmann::json log = readJson(path("log.json"));
    CHECK(log["result"]["held_out"].size() == 1);
    CHECK(log["result"]["skipped_steps"] == 0);
    CHECK(fileBytes(path("loss.svg")).size() > 500);
    CHECK(fileBytes(path("heldout_0.png")).size() > 500);

    // The command that the file holds makes it again, from frames that it makes again.
    std::istringstream words(weights.metadata.at("command"));
    std::vector<std::string> again{std::istream_iterator<std::string>(words), {}};
    again.erase(again.begin());
    again.insert(again.end(),
                 {"--held-out", "1", "--data", path("frames again"), "-o", path("b.safetensors")});
    REQUIRE(runCommand(again).exitCode == 0);
    CHECK(fileBytes(path("a.safetensors")) == fileBytes(path("b.safetensors")));

    // The frames are there now; those of other settings are refused.
    const CommandResult other = runCommand(train(folder, "c.safetensors", {"--data-seed", "2"}));
    CHECK(other.exitCode == 1);
    CHECK(other.errors.find("made with another seed") != std::string::npos);
    CHECK(std::count(other.errors.begin(), other.errors.end(), '\n') == 1);
    CHECK_FALSE(std::filesystem::exists(path("c.safetensors")));
}

TEST_CASE("hair train plans a step's memory without rendering or writing")
{
    const TemporaryFolder folder;
    std::vector<std::string> arguments = train(folder, "w.safetensors", {"--batch", "2"});
    arguments.push_back("--memory");
    const CommandResult result = runCommand(arguments);
    CAPTURE(result.errors);
    REQUIRE(result.exitCode == 0);
    CHECK(result.output.find("small network, one training step of 2 crops of 16 pixels") == 0);
    CHECK(result.output.find("sharing memory") != std::string::npos);
    CHECK(listFolder(folder.path()).empty());
}

TEST_CASE("hair train refuses what it cannot do, in one line")
{
    const TemporaryFolder folder;
    const auto fails = [&](const std::vector<std::string>& more, const char* reason) {
        const CommandResult result = runCommand(train(folder, "w.safetensors", more));
        CAPTURE(result.errors);
        CHECK(result.exitCode == 1);
        CHECK(result.errors.starts_with("error: "));
        CHECK(result.errors.find(reason) != std::string::npos);
        CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
    };
    fails({"--target-spp", "12"}, "multiple of 8");
    fails({"--strand-share", "0"}, "share");
    fails({"--net", "huge"}, "huge");
    fails({"--curve", "loss.pdf"}, ".svg");
    fails({"--init", (folder.path() / "none.safetensors").string()}, "none.safetensors");
    CHECK_FALSE(std::filesystem::exists(folder.path() / "w.safetensors"));
}
