// Files are whole or not there.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"

using namespace strandlight;
namespace fs = std::filesystem;

namespace {

fs::path scratchFolder()
{
    const fs::path folder = fs::temp_directory_path() / "strandlight_test_file";
    fs::create_directories(folder);
    return folder;
}

} // namespace

TEST_CASE("CRC-32 has the published check value")
{
    const std::string text = "123456789";
    CHECK(crc32({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}) == 0xCBF43926u);
}

TEST_CASE("a file is written whole, read back, and replaced in one step")
{
    const fs::path path = scratchFolder() / "value.txt";
    writeFileAtomically(path, std::string_view("first"));
    writeFileAtomically(path, std::string_view("second, longer"));
    const std::vector<std::uint8_t> bytes = readFile(path);
    CHECK(std::string(bytes.begin(), bytes.end()) == "second, longer");
    for (const fs::directory_entry& entry : fs::directory_iterator(scratchFolder()))
        CHECK(entry.path().filename().string().find(".tmp.") == std::string::npos);
}

TEST_CASE("a write that cannot happen leaves the old file and names the path")
{
    const fs::path folder = scratchFolder() / "is_a_folder";
    fs::create_directories(folder / "inside");
    CHECK_THROWS_AS(writeFileAtomically(folder, std::string_view("x")), FileError);
    CHECK(fs::exists(folder / "inside"));
    CHECK_THROWS_AS(
        writeFileAtomically(scratchFolder() / "no such folder" / "a", std::string_view("x")),
        FileError);
}

TEST_CASE("missing files, folders and files past the limit are refused")
{
    CHECK_THROWS_AS(readFile(scratchFolder() / "not there"), FileError);
    CHECK_THROWS_AS(readFile(scratchFolder()), FileError);
    const fs::path path = scratchFolder() / "large.bin";
    writeFileAtomically(path, std::string(1000, 'x'));
    CHECK_THROWS_AS(readFile(path, 999), FileError);
    CHECK(readFile(path, 1000).size() == 1000);
}

TEST_CASE("temporaries of dead processes are swept, those of living ones stay")
{
    const fs::path path = scratchFolder() / "swept.bin";
    const fs::path dead = path.string() + ".tmp.999999999";
    const fs::path alive = path.string() + ".tmp.1";
    writeFileAtomically(dead, std::string_view("x"));
    writeFileAtomically(alive, std::string_view("x"));
    removeStaleTemporaries(path);
    CHECK_FALSE(fs::exists(dead));
    CHECK(fs::exists(alive));
    fs::remove(alive);
}
