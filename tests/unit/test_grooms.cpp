// Procedural hair: where it is, how long it is, and that it is always the same.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/scene/camera.hpp"
#include "engine/scene/grooms.hpp"
#include "engine/scene/hair_head.hpp"

using namespace strandlight;

namespace {

// fp32 steps along the surface: 2e-6 was the most that any groom went below it.
constexpr float kSurfaceTolerance = 1e-5f;

GroomSettings small(const std::string& name)
{
    GroomSettings settings = groomSettings(name);
    settings.strands = 2000;
    return settings;
}

float strandLength(const HairStrands& hair, std::uint32_t strand)
{
    float length = 0.0f;
    for (std::uint32_t i = hair.firstPoint[strand]; i + 1 < hair.firstPoint[strand + 1]; ++i)
        length += glm::length(hair.points[i + 1] - hair.points[i]);
    return length;
}

float lowestLevel(const HairStrands& hair)
{
    float lowest = std::numeric_limits<float>::max();
    for (std::uint32_t s = 0; s < hair.strandCount(); ++s)
        for (std::uint32_t i = hair.firstPoint[s]; i + 1 < hair.firstPoint[s + 1]; ++i)
            lowest = std::min(lowest, lowestHeadLevel(hair.points[i], hair.points[i + 1]));
    return lowest;
}

bool sameBits(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

glm::vec3 meanTip(const HairStrands& hair)
{
    glm::vec3 sum(0.0f);
    for (std::uint32_t s = 0; s < hair.strandCount(); ++s)
        sum += hair.points[hair.firstPoint[s + 1] - 1];
    return sum / static_cast<float>(hair.strandCount());
}

} // namespace

TEST_CASE("every groom has roots on the scalp, stays outside of the head and keeps its lengths")
{
    REQUIRE(groomNames().size() == 6);
    for (const std::string& name : groomNames()) {
        CAPTURE(name);
        const GroomSettings settings = small(name);
        const HairStrands hair = makeGroom(name, settings);
        REQUIRE_NOTHROW(checkHair(hair));
        CHECK(hair.name == name);
        CHECK(hair.strandCount() == settings.strands);
        CHECK(hair.segmentCount() == settings.strands * settings.segments);
        CHECK(lowestLevel(hair) > 1.0f - kSurfaceTolerance);

        float shortest = 1e9f;
        float longest = 0.0f;
        float farthestRoot = 0.0f;
        for (std::uint32_t s = 0; s < hair.strandCount(); ++s) {
            const glm::vec3 root = hair.points[hair.firstPoint[s]];
            farthestRoot = std::max(farthestRoot, std::abs(headLevel(root) - 1.0f));
            shortest = std::min(shortest, strandLength(hair, s));
            longest = std::max(longest, strandLength(hair, s));
        }
        CHECK(farthestRoot < kSurfaceTolerance);
        // Steps of unit directions: rounding of up to 32 of them stays below 1e-4.
        CHECK(longest < settings.lengthMetres * 1.0001f);
        CHECK(shortest > settings.lengthMetres * (1.0f - settings.lengthVariation) * 0.9999f);
        CHECK(longest > shortest * 1.1f);
    }
}

TEST_CASE("a groom is the same every time and another with another seed")
{
    for (const std::string& name : groomNames()) {
        CAPTURE(name);
        GroomSettings settings = small(name);
        settings.strands = 300;
        const HairStrands first = makeGroom(name, settings);
        const HairStrands again = makeGroom(name, settings);
        CHECK(sameBits(first.points, again.points));
        CHECK(sameBits(first.colors, again.colors));
        CHECK(first.radii == again.radii);
        settings.seed += 1;
        CHECK_FALSE(sameBits(first.points, makeGroom(name, settings).points));
    }
}

TEST_CASE("styles differ as their names say")
{
    const HairStrands straight = makeGroom("straight", small("straight"));
    const HairStrands tail = makeGroom("ponytail", small("ponytail"));
    CHECK(meanTip(straight).y < -0.15f);                       // falls below the chin
    CHECK(meanTip(tail).z < -0.1f);                            // behind the head
    CHECK(std::abs(meanTip(tail).x) < 0.02f);                  // in the middle
    CHECK(meanTip(makeGroom("afro", small("afro"))).y > 0.0f); // stands
    CHECK(makeGroom("short", small("short")).boundsMin().y > -0.11f);
}

TEST_CASE("clumping brings the tips of a lock together, frizz takes them apart")
{
    const auto spread = [](float clumping, float frizz) {
        GroomSettings settings = groomSettings("straight");
        settings.strands = 60; // one lock
        settings.clumping = clumping;
        settings.frizz = frizz;
        const HairStrands hair = makeGroom("straight", settings);
        const glm::vec3 mean = meanTip(hair);
        float sum = 0.0f;
        for (std::uint32_t s = 0; s < hair.strandCount(); ++s)
            sum += glm::length(hair.points[hair.firstPoint[s + 1] - 1] - mean);
        return sum / static_cast<float>(hair.strandCount());
    };
    CHECK(spread(1.0f, 0.0f) < 0.6f * spread(0.0f, 0.0f));
    CHECK(spread(1.0f, 0.0f) < spread(1.0f, 0.5f));
}

TEST_CASE("colours vary by strand and from root to tip, and radii taper")
{
    GroomSettings settings = small("wavy");
    HairStrands hair = makeGroom("wavy", settings);
    const std::uint32_t tip = hair.firstPoint[1] - 1;
    CHECK(hair.colors[tip].y > hair.colors[0].y);
    CHECK(hair.colors[0] != hair.colors[tip + 1]);
    CHECK(hair.radii[0] == settings.radiusMetres);
    CHECK(hair.radii[tip] == doctest::Approx(0.1f * settings.radiusMetres));
    settings.colorVariation = 0.0f;
    hair = makeGroom("wavy", settings);
    CHECK(std::all_of(hair.colors.begin(), hair.colors.end(),
                      [&](glm::vec3 c) { return c == settings.color; }));
}

TEST_CASE("grooms at the ends of their ranges")
{
    for (const std::string& name : groomNames()) {
        CAPTURE(name);
        GroomSettings settings = groomSettings(name);
        settings.strands = 50;
        settings.segments = kMostGroomSegments;
        settings.lengthMetres = 2.0f;
        settings.frizz = 1.0f;
        settings.clumping = 1.0f;
        const HairStrands fine = makeGroom(name, settings);
        REQUIRE_NOTHROW(checkHair(fine));
        CHECK(lowestLevel(fine) > 1.0f - 10.0f * kSurfaceTolerance); // 256 steps, not 32
        settings.strands = 1;
        settings.segments = 1;
        REQUIRE_NOTHROW(checkHair(makeGroom(name, settings)));
    }
}

TEST_CASE("grooms refuse settings out of range, with the value")
{
    GroomSettings settings;
    CHECK_THROWS_WITH_AS(makeGroom("mullet", settings),
                         "'mullet' is not a groom: straight, wavy, curly, afro, ponytail, short",
                         Error);
    settings.strands = kMostGroomStrands + 1;
    CHECK_THROWS_WITH_AS(makeGroom("afro", settings),
                         "groom: 200001 strands are outside of 1 .. 200000", Error);
    settings = {};
    settings.segments = 0;
    CHECK_THROWS_AS(makeGroom("afro", settings), Error);
    settings = {};
    settings.lengthMetres = std::nanf("");
    CHECK_THROWS_AS(makeGroom("afro", settings), Error);
    settings = {};
    settings.frizz = -0.5f;
    CHECK_THROWS_WITH_AS(makeGroom("afro", settings), "groom: frizz of -0.5 is outside of 0 .. 1",
                         Error);
}

TEST_CASE("the head lies inside of its ellipsoid and the default camera sees all of a groom")
{
    const Scene head = headScene();
    float highest = 0.0f;
    for (const Vertex& vertex : head.vertices) {
        CHECK(glm::length(vertex.normal) == doctest::Approx(1.0f));
        if (vertex.position.y > -0.05f) // the neck begins there
            highest = std::max(highest, headLevel(vertex.position));
    }
    CHECK(highest == doctest::Approx(1.0f));
    CHECK(head.lights.size() == 2);

    const HairStrands hair = makeGroom("afro", small("afro"));
    const glm::mat4 view = cameraViewProjection(hairCamera(hair), 64, 64, {0.01f, 10.0f});
    float widest = 0.0f;
    for (const glm::vec3& p : hair.points) {
        const glm::vec4 clip = view * glm::vec4(p, 1.0f);
        widest = std::max({widest, std::abs(clip.x / clip.w), std::abs(clip.y / clip.w)});
    }
    CHECK(widest < 1.0f);
    CHECK(widest > 0.7f); // and fills the picture
}
