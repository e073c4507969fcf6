// Truths of hair that are kept as files: the same bits, and a damaged or foreign file never counts.
#include <cstring>
#include <filesystem>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "passes/hair_truth.hpp"
#include "tests/gpu/hair_cases.hpp"
#include "tests/support/gltf_maker.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

bool sameBits(const HairFrame& a, const HairFrame& b)
{
    const std::size_t bytes = a.radiance.pixels.size() * sizeof(glm::vec4);
    return a.radiance.pixels.size() == b.radiance.pixels.size() &&
           std::memcmp(a.radiance.pixels.data(), b.radiance.pixels.data(), bytes) == 0 &&
           std::memcmp(a.hair.pixels.data(), b.hair.pixels.data(), bytes) == 0;
}

std::size_t filesIn(const std::filesystem::path& folder)
{
    return std::size_t(std::distance(std::filesystem::directory_iterator(folder), {}));
}

} // namespace

TEST_CASE("hair truth: kept once, found again, made anew when the file or the frame is another")
{
    const TemporaryFolder folder;
    HairStrands hair = layers(2, 16.0f);
    HairRenderSettings settings = plainSettings(16);
    settings.mode = HairMode::Reference;
    settings.frames = 2;
    const auto truth = [&] {
        return hairTruth(context(), hair, nullptr, pixelCamera(16), settings, folder.path());
    };
    const HairFrame made = truth();
    CHECK_FALSE(made.timings.empty());
    REQUIRE_EQ(filesIn(folder.path()), 1);
    const HairFrame kept = truth();
    CHECK(kept.timings.empty()); // nothing was drawn
    CHECK(sameBits(made, kept));

    const std::filesystem::path file = std::filesystem::directory_iterator(folder.path())->path();
    std::vector<std::uint8_t> bytes = readFile(file);
    bytes[bytes.size() / 2] ^= 1;
    writeFileAtomically(file, bytes);
    const HairFrame again = truth();
    CHECK_FALSE(again.timings.empty());
    CHECK(sameBits(made, again));
    CHECK(truth().timings.empty());

    settings.frames = 3;
    CHECK_FALSE(truth().timings.empty());
    hair.colors[0].x += 0.25f;
    CHECK_FALSE(truth().timings.empty());
    CHECK_EQ(filesIn(folder.path()), 3);
    settings.mode = HairMode::Stochastic;
    CHECK_THROWS_AS((void)truth(), Error);
}
