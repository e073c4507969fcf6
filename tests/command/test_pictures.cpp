// What compare and report say about pictures whose differences are known.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "engine/base/image_io.hpp"
#include "tests/command/run_command.hpp"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

struct Pictures
{
    TemporaryFolder folder;
    std::string half = (folder.path() / "half.exr").string();       // 0.5 everywhere
    std::string quarter = (folder.path() / "quarter.exr").string(); // 0.25 everywhere
    std::string json = (folder.path() / "out.json").string();

    Pictures()
    {
        saveExr(half, CpuImage(32, 24, glm::vec4(0.5f)));
        saveExr(quarter, CpuImage(32, 24, glm::vec4(0.25f)));
    }
};

} // namespace

TEST_CASE("compare measures constant pictures exactly")
{
    const Pictures p;
    const CommandResult result = runCommand({"compare", p.half, p.quarter, "--json", p.json});
    CAPTURE(result.errors);
    REQUIRE(result.exitCode == 0);
    CHECK(result.output.find("RMSE        0.25\n") != std::string::npos);

    const nlohmann::json r = readJson(p.json)["result"];
    // Halves and quarters are exact in fp32 and sums of them in fp64: only the division rounds.
    CHECK(r["rmse"].get<double>() == doctest::Approx(0.25).epsilon(1e-9));
    CHECK(r["relmse"].get<double>() == doctest::Approx(0.0625 / 0.0725).epsilon(1e-6));
    CHECK(r["block_rmse_percent"].get<double>() == doctest::Approx(100.0).epsilon(1e-9));
    CHECK(r["mean"][1].get<double>() == doctest::Approx(0.5).epsilon(1e-9));
    CHECK(r["reference_mean"][2].get<double>() == doctest::Approx(0.25).epsilon(1e-9));
    // sRGB codes of 0.5 and 0.25 by the standard's formula; PSNR in dB of their difference.
    const double coded = 1.055 * (std::pow(0.5, 1.0 / 2.4) - std::pow(0.25, 1.0 / 2.4));
    CHECK(r["psnr_db"].get<double>() == doctest::Approx(-20.0 * std::log10(coded)).epsilon(1e-4));
    CHECK(r["flip"].get<double>() > 0.1); // a clearly visible step in lightness
    CHECK(r["flip"].get<double>() < 1.0);
}

TEST_CASE("equal pictures have no difference; exposure makes unequal ones equal only by clamping")
{
    const Pictures p;
    const CommandResult same = runCommand({"compare", p.half, p.half, "--json", p.json});
    REQUIRE(same.exitCode == 0);
    nlohmann::json r = readJson(p.json)["result"];
    CHECK(r["rmse"] == 0.0);
    CHECK(r["flip"] == 0.0);
    CHECK(r["ssim"].get<double>() == doctest::Approx(1.0).epsilon(1e-9));
    CHECK(r["psnr_db"].is_null()); // infinite

    // Three stops up both are over 1: equal on a display, not as radiance.
    const CommandResult bright =
        runCommand({"compare", p.half, p.quarter, "--exposure", "3", "--json", p.json});
    REQUIRE(bright.exitCode == 0);
    r = readJson(p.json)["result"];
    CHECK(r["flip"] == 0.0);
    CHECK(r["rmse"].get<double>() == doctest::Approx(0.25).epsilon(1e-9));
}

TEST_CASE("pixels that are not finite are counted, not averaged")
{
    const Pictures p;
    CpuImage image(32, 24, glm::vec4(0.25f));
    image.at(3, 4).g = std::numeric_limits<float>::quiet_NaN();
    image.at(5, 6).r = std::numeric_limits<float>::infinity();
    const std::string broken = (p.folder.path() / "broken.exr").string();
    saveExr(broken, image);
    const CommandResult result = runCommand({"compare", broken, p.quarter, "--json", p.json});
    REQUIRE(result.exitCode == 0);
    const nlohmann::json r = readJson(p.json)["result"];
    CHECK(r["non_finite"] == 2);
    CHECK(r["rmse"] == 0.0);
    CHECK(result.output.find("2 pixels that are not finite") != std::string::npos);
}

TEST_CASE("the report is one file that needs nothing else")
{
    const Pictures p;
    const std::string page = (p.folder.path() / "report.html").string();
    const CommandResult result = runCommand({"report", "--render", p.half, "--reference", p.quarter,
                                             "--title", "<b>R&D</b>", "-o", page});
    CAPTURE(result.errors);
    REQUIRE(result.exitCode == 0);
    const std::vector<std::uint8_t> bytes = fileBytes(page);
    const std::string html(bytes.begin(), bytes.end());
    CHECK(html.find("<!doctype html>") == 0);
    CHECK(html.find("&lt;b&gt;R&amp;D&lt;/b&gt;") != std::string::npos);
    CHECK(html.find("<b>R&D") == std::string::npos);
    CHECK(html.find("data:image/png;base64,iVBORw0KGgo") != std::string::npos);
    CHECK(html.find("http") == std::string::npos); // no network
    CHECK(html.find(" src=\"data:") != std::string::npos);
    CHECK(html.find("prefers-color-scheme: dark") != std::string::npos);
}

TEST_CASE("a report of results that are not ours is refused")
{
    const Pictures p;
    const std::string text = p.folder.write("notes.json", {'[', '1', ']'}).string();
    const std::string page = (p.folder.path() / "report.html").string();
    checkFails(runCommand({"report", "--render", p.half, "--reference", p.quarter, "--results",
                           text, "-o", page}),
               "notes.json");
    CHECK(!std::filesystem::exists(page));
}
