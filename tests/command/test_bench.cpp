// Benchmarks through the command: not how fast, but that each row was checked and the files are
// right.
#include <doctest/doctest.h>

#include <fstream>

#include "tests/command/run_command.hpp"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight::test;

TEST_CASE("bench kernels checks a case, times it and writes its rows")
{
    const TemporaryFolder folder;
    const std::string json = (folder.path() / "rows.json").string();
    const std::string csv = (folder.path() / "rows.csv").string();
    const CommandResult result = runCommand(
        {"bench", "kernels", "--quick", "--filter", "SG mixture", "--json", json, "--csv", csv});
    CAPTURE(result.errors);
    REQUIRE(result.exitCode == 0);
    CHECK(result.output.find("of_multiply_add") != std::string::npos);

    const nlohmann::json written = readJson(json);
    CHECK(written["settings"]["quick"] == true);
    CHECK(written["ceilings"]["multiply_add_gflops"] > 0.0);
    const nlohmann::json& row = written["rows"].back();
    CHECK(row["name"].get<std::string>().find("SG mixture") == 0);
    CHECK(row["error"] < 5e-6);
    CHECK(row["ms_minimum"] > 0.0);
    CHECK(row["ms_minimum"] <= row["ms_median"]);

    std::ifstream lines(csv);
    std::string line;
    std::size_t count = 0;
    while (std::getline(lines, line))
        ++count;
    CHECK(count == written["rows"].size() + 1); // the header
}

TEST_CASE("bench kernels plans the memory of training without running it")
{
    const CommandResult result = runCommand({"bench", "kernels", "--memory"});
    CAPTURE(result.errors);
    REQUIRE(result.exitCode == 0);
    CHECK(result.output.find("sharing memory") != std::string::npos);
}
