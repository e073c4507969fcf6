// Flicker and coverage error of made-up frames.
#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "passes/hair_study.hpp"

using namespace strandlight;

namespace {

HairFrame stripes(std::uint32_t shift)
{
    HairFrame frame;
    frame.radiance = CpuImage(16, 12);
    frame.hair = CpuImage(16, 12, glm::vec4(0.0f, 0.0f, 0.0f, 0.5f));
    for (std::uint32_t y = 0; y < 12; ++y)
        for (std::uint32_t x = 0; x < 16; ++x)
            frame.radiance.at(x, y) = glm::vec4(float((x + 16 - shift) % 4));
    return frame;
}

} // namespace

TEST_CASE("flicker: a picture that only moves has none, another has its mean change")
{
    const HairFrame first = stripes(0);
    CHECK(hairFlicker(first, stripes(1)) == 0.0);
    HairFrame brighter = stripes(1);
    for (glm::vec4& pixel : brighter.radiance.pixels)
        pixel += 0.25f;
    CHECK(hairFlicker(first, brighter) == doctest::Approx(0.25));
    HairFrame none = first; // no hair, nothing to flicker
    for (glm::vec4& pixel : none.hair.pixels)
        pixel.w = 1.0f;
    CHECK(hairFlicker(none, none) == 0.0);
    none.radiance = CpuImage(4, 4);
    CHECK_THROWS_AS(hairFlicker(first, none), Error);
}

TEST_CASE("coverage error is the mean difference of transmittances")
{
    const HairFrame truth = stripes(0);
    HairFrame frame = truth;
    for (std::size_t i = 0; i < frame.hair.pixels.size(); i += 2)
        frame.hair.pixels[i].w = 0.1f;
    CHECK(compareHair(frame, truth).coverage == doctest::Approx(0.2));
    CHECK(compareHair(frame, truth).picture.rmse == 0.0);
}
