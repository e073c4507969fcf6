// The table of fits through the command.
#include <doctest/doctest.h>

#include <map>

#include "tests/command/run_command.hpp"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight::test;

TEST_CASE("fits measures every model at texels and between them")
{
    const TemporaryFolder folder;
    const std::string json = (folder.path() / "fits.json").string();
    const CommandResult result =
        runCommand({"fits", "--fit", "direct", "builtin:room", "--atlas", "24", "--lightfield", "8",
                    "--spp", "8", "--steps", "300", "--json", json});
    CAPTURE(result.errors);
    REQUIRE(result.exitCode == 0);
    CHECK(result.output.find("direct") != std::string::npos);

    const nlohmann::json r = readJson(json)["result"];
    REQUIRE(r["rows"].size() == 5); // raw images, SH L1, SH L2, fixed SGs, direct
    CHECK(r["points_between"] > 20);
    std::map<std::string, nlohmann::json> rows;
    for (const nlohmann::json& row : r["rows"]) {
        CAPTURE(row["model"]);
        CHECK((row["texel_rmse"] > 0.0) == (row["model"] != "raw images")); // those are the truth
        CHECK(row["interpolated_rmse"] > 0.0);
        CHECK(row["bytes_per_texel"] > 0.0);
        rows[row["model"]] = row;
    }
    // Nine coefficients cannot be worse than four of them at the texels they were fitted to.
    CHECK(rows["SH L2"]["texel_rmse"] <= rows["SH L1"]["texel_rmse"]);
    // Lobes that may move keep light better than lobes that may not, texel or between.
    CHECK(rows["direct"]["texel_rmse"] < rows["8 fixed SGs"]["texel_rmse"]);
    CHECK(rows["direct"]["interpolated_rmse"] < rows["8 fixed SGs"]["interpolated_rmse"]);
}
