// The stress matrix through the command; its long form is for people.
#include <doctest/doctest.h>

#include <set>

#include "tests/command/run_command.hpp"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight::test;

TEST_CASE("stress: one round of one group, as a table and as JSON, the same numbers twice")
{
    const TemporaryFolder folder;
    nlohmann::json rows[2];
    for (int i = 0; i < 2; ++i) {
        const std::string json = (folder.path() / (std::to_string(i) + ".json")).string();
        const CommandResult result = runCommand({"stress", "--group", "storage", "--minutes", "0",
                                                 "--items", "512", "--seed", "9", "--json", json});
        CAPTURE(result.output);
        CAPTURE(result.errors);
        REQUIRE(result.exitCode == 0);
        CHECK(result.output.find("0 non-finite, 0 misses") != std::string::npos);
        rows[i] = readJson(json)["result"]["rows"];
    }
    CHECK(rows[0] == rows[1]);
    std::set<std::string> names;
    for (const nlohmann::json& row : rows[0]) {
        CHECK(row["group"] == "storage");
        CHECK(row["cases"] > 0);
        CHECK(row["misses"] == 0);
        names.insert(row["name"]);
    }
    CHECK(names.contains("RGB9E5, device"));
    CHECK(names.contains("fp16, all 65,536 values"));
}

TEST_CASE("stress: an unknown group is an error that lists the known ones")
{
    checkFails(runCommand({"stress", "--group", "nonsense", "--minutes", "0"}), "adversaries");
}
