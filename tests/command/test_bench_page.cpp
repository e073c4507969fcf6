// The page about benchmarks, drawn from hand-made results: no device is needed.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string>
#include <vector>

#include "engine/base/image_io.hpp"
#include "tests/command/run_command.hpp"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

std::string textOf(const std::filesystem::path& path)
{
    const std::vector<std::uint8_t> bytes = fileBytes(path);
    return {bytes.begin(), bytes.end()};
}

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

// Elements close in the order in which they were opened, and every attribute is quoted.
bool wellFormed(const std::string& xml)
{
    std::vector<std::string> open;
    for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at)) {
        const std::size_t end = xml.find('>', at);
        if (end == std::string::npos)
            return false;
        const std::string tag = xml.substr(at + 1, end - at - 1);
        at = end;
        if (tag.find('<') != std::string::npos || std::count(tag.begin(), tag.end(), '"') % 2 != 0)
            return false;
        const std::size_t start = tag[0] == '/' ? 1 : 0;
        std::size_t stop = start;
        while (stop < tag.size() && std::isalnum(static_cast<unsigned char>(tag[stop])))
            ++stop;
        const std::string name = tag.substr(start, stop - start);
        if (start == 0 && tag.back() != '/') {
            open.push_back(name);
        } else if (start == 1) {
            if (open.empty() || open.back() != name)
                return false;
            open.pop_back();
        }
    }
    return open.empty();
}

nlohmann::json sixRows()
{
    nlohmann::json rows = nlohmann::json::array();
    const auto add = [&](const char* name, nlohmann::json bytes, nlohmann::json error,
                         const char* way) {
        rows.push_back({{"name", name}, {"bytes", bytes}, {"error", error}, {"way", way}});
    };
    add("a < b & c", 10, 0.5, "one"); // the front: 10, 40 and 1000
    add("b", 20, 0.6, "one");
    add("c", 40, 0.1, "two");
    add("d", 1000, 0.03, "two");
    add("not drawn: zero on a log axis", 0, 0.5, "two");
    add("not drawn: not measured", 50, nullptr, "one");
    return rows;
}

// A folder with gi.json, as `bench gi` would leave it, and its pictures.
void writeResults(const TemporaryFolder& folder)
{
    CpuImage picture(32, 24);
    for (std::uint32_t y = 0; y < 24; ++y)
        for (std::uint32_t x = 0; x < 32; ++x)
            picture.at(x, y) = glm::vec4(float(x) / 31.0f, float(y) / 23.0f, 0.4f, 1.0f);
    for (const char* name : {"ours.png", "truth.png", "error.png"})
        savePng(folder.path() / name, picture);
    const nlohmann::json bench = {
        {"command", "bench gi"},
        {"date", "2020-02-02 02:02 UTC"},
        {"device", {{"name", "a device"}, {"driver", "a driver"}}},
        {"rows", sixRows()},
        {"columns", {{"bytes", {{"label", "stored"}, {"unit", "bytes"}}}}},
        {"facts", {{{"label", "least error"}, {"value", "0.03"}}}},
        {"plots",
         {{{"title", "Bytes against error"},
           {"x", "bytes"},
           {"y", "error"},
           {"series", "way"},
           {"front", true},
           {"lines", true}},
          {{"title", "One way"},
           {"x", "bytes"},
           {"y", "error"},
           {"series", "way"},
           {"where", {{"way", {"two", "three"}}}}}}},
        {"pictures",
         {{{"title", "a room"},
           {"ours", "ours.png"},
           {"truth", "truth.png"},
           {"error", "error.png"}}}},
        {"passes",
         {{{"title", "Passes"},
           {"rows", {{{"name", "gbuffer"}, {"milliseconds", 2.5}}}},
           {"skipped", {"punctual lights: the scene has none"}}}}}};
    const std::string text = bench.dump();
    folder.write("gi.json", {text.begin(), text.end()});
}

CommandResult drawPage(const TemporaryFolder& folder)
{
    return runCommand({"bench", "report", "--out", folder.path().string()});
}

std::string findChromium()
{
    const char* path = std::getenv("PATH");
    std::string rest = path ? path : "";
    while (!rest.empty()) {
        const std::size_t colon = rest.find(':');
        const auto program = std::filesystem::path(rest.substr(0, colon)) / "chromium";
        if (std::filesystem::exists(program))
            return program.string();
        rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
    }
    return "";
}

} // namespace

TEST_CASE("the page of benchmarks has a mark for every point and needs nothing else")
{
    const TemporaryFolder folder;
    writeResults(folder);
    const CommandResult result = drawPage(folder);
    CAPTURE(result.errors);
    REQUIRE(result.exitCode == 0);
    const std::string html = textOf(folder.path() / "report.html");
    const std::size_t first = html.find("<svg class=\"plot\"");
    const std::size_t second = html.find("<svg class=\"plot\"", first + 1);
    REQUIRE(second != std::string::npos);
    const auto svgAt = [&](std::size_t at) {
        return html.substr(at, html.find("</svg>", at) + 6 - at);
    };
    CHECK(wellFormed(svgAt(first)));
    CHECK(count(svgAt(first), "class=\"mark ") == 4); // two of six cannot be drawn
    CHECK(count(svgAt(first), "<polyline class=\"line ") == 2);
    CHECK(svgAt(first).find("a &lt; b &amp; c") != std::string::npos);
    CHECK(count(svgAt(second), "class=\"mark ") == 2);
    CHECK(count(svgAt(second), "<polyline") == 0);

    // Three of the four points are on the front: three pairs of coordinates.
    const std::size_t front = html.find("<polyline class=\"front\" points=\"");
    REQUIRE(front != std::string::npos);
    const std::string points = html.substr(front, html.find("/>", front) - front);
    CHECK(count(points, ",") == 3);

    CHECK(html.find("stored, bytes") != std::string::npos);
    CHECK(html.find("Not run: punctual lights: the scene has none.") != std::string::npos);
    CHECK(html.find("a device, driver a driver") != std::string::npos);
    CHECK(html.find("2020-02-02") != std::string::npos);
    CHECK(html.find("http") == std::string::npos); // no network
    CHECK(count(html, " src=") == count(html, " src=\"data:image/png;base64,iVBORw0KGgo"));
    CHECK(html.find("prefers-color-scheme: dark") != std::string::npos);
}

TEST_CASE("a page of no results, or of somebody else's, is refused")
{
    const TemporaryFolder folder;
    checkFails(drawPage(folder), "holds no");
    folder.write("gi.json", {'[', '1', ']'});
    checkFails(drawPage(folder), "gi.json");
    CHECK(!std::filesystem::exists(folder.path() / "report.html"));
}

TEST_CASE("the page loads in Chromium without a script error")
{
    const std::string chromium = findChromium();
    if (chromium.empty()) {
        MESSAGE("chromium is not installed: not tested");
        return;
    }
    const TemporaryFolder folder;
    writeResults(folder);
    REQUIRE(drawPage(folder).exitCode == 0);
    const std::filesystem::path picture = folder.path() / "page.png";
    const std::filesystem::path log = folder.path() / "log.txt";
    const std::string command =
        chromium + " --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir='" +
        (folder.path() / "profile").string() + "' --enable-logging=stderr --window-size=1000,800" +
        " --screenshot='" + picture.string() + "' 'file://" +
        (folder.path() / "report.html").string() + "' >'" + log.string() + "' 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
    const CpuImage shot = loadImage(picture);
    CHECK(shot.width == 1000);
    float low = 1.0f, high = 0.0f;
    for (const glm::vec4& pixel : shot.pixels) {
        low = std::min(low, pixel.g);
        high = std::max(high, pixel.g);
    }
    CHECK(high - low > 0.5f); // not blank: ink on its ground, whatever the scheme
    const std::string said = textOf(log);
    CAPTURE(said);
    CHECK(said.find("Uncaught") == std::string::npos); // "Uncaught ReferenceError: ..."
}
