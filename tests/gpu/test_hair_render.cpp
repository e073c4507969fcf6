// The hair passes on the device: transmittance of stacked layers, coverage of thin strands, exact
// coverage, hiding, shadows, repeatability, and that a scene without hair costs nothing.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "passes/hair_passes.hpp"
#include "passes/hair_render.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

// A picture plane at z = 0 in which one unit is one pixel of a side x side picture, y up, origin in
// the middle.
Camera pixelCamera(std::uint32_t side)
{
    Camera camera;
    camera.eye = {0.0f, 0.0f, 4.0f * float(side)};
    camera.target = glm::vec3(0.0f);
    camera.verticalFovDegrees = glm::degrees(2.0f * std::atan(0.5f / 4.0f));
    return camera;
}

void addStrand(HairStrands& hair, std::initializer_list<glm::vec3> points, float radius)
{
    if (hair.firstPoint.empty())
        hair.firstPoint.push_back(0);
    for (const glm::vec3& point : points) {
        hair.points.push_back(point);
        hair.radii.push_back(radius);
        hair.colors.emplace_back(0.5f);
    }
    hair.firstPoint.push_back(std::uint32_t(hair.points.size()));
}

// Layers that each cover the whole picture: ribbons many pixels wide, one behind the other.
HairStrands layers(std::uint32_t count, float side)
{
    HairStrands hair;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float z = -1.0f * float(i);
        addStrand(hair, {{-2.0f * side, 0.0f, z}, {2.0f * side, 0.0f, z}}, 2.0f * side);
    }
    return hair;
}

HairRenderSettings plainSettings(std::uint32_t side)
{
    HairRenderSettings settings;
    settings.width = settings.height = side;
    settings.lod = 1;
    settings.shadows = false;
    return settings;
}

double meanTransmittance(const CpuImage& hair)
{
    double sum = 0.0;
    for (const glm::vec4& pixel : hair.pixels)
        sum += double(pixel.w);
    return sum / double(hair.pixels.size());
}

constexpr std::uint32_t kCells = 4, kCell = 96, kGridSide = kCells * kCell;
constexpr float kStrandLength = 64.0f;

// Of parallel strands, in pixels: they never overlap, not even as ribbons a pixel wide with a
// border, and are off the pixels' grid, so that their mean is the expected coverage of one strand.
float strandSpacing(float width)
{
    return std::max(1.0f, width) + 1.37f;
}
int strandsPerCell(float width)
{
    return int(kStrandLength / strandSpacing(width)) | 1;
}

// 16 cells, one angle each.
HairStrands strandGrid(float width)
{
    HairStrands hair;
    for (std::uint32_t cell = 0; cell < kCells * kCells; ++cell) {
        const float angle = float(cell) * 3.14159265f / 16.0f;
        const glm::vec3 along(std::cos(angle), std::sin(angle), 0.0f);
        const glm::vec3 across(-along.y, along.x, 0.0f);
        const glm::vec3 middle(
            (float(cell % kCells) + 0.5f) * float(kCell) - 0.5f * float(kGridSide) + 0.137f,
            (float(cell / kCells) + 0.5f) * float(kCell) - 0.5f * float(kGridSide) + 0.291f, 0.0f);
        const int strands = strandsPerCell(width);
        for (int s = 0; s < strands; ++s) {
            const glm::vec3 place =
                middle + across * (strandSpacing(width) * float(s - strands / 2));
            const glm::vec3 half = along * (0.5f * kStrandLength);
            // Several segments: their joints must neither gap nor overlap.
            addStrand(hair, {place - half, place - 0.3f * half, place + 0.2f * half, place + half},
                      0.5f * width);
        }
    }
    return hair;
}

// Covered area of each cell over that of its strands' rectangles.
std::vector<double> relativeCoverage(const CpuImage& picture, bool transmittanceInX, float width)
{
    std::vector<double> covered(kCells * kCells, 0.0);
    for (std::uint32_t y = 0; y < kGridSide; ++y)
        for (std::uint32_t x = 0; x < kGridSide; ++x) {
            const std::uint32_t cell = (kCells - 1 - y / kCell) * kCells + x / kCell; // y up
            const glm::vec4& pixel = picture.at(x, y);
            covered[cell] += 1.0 - double(transmittanceInX ? pixel.x : pixel.w);
        }
    for (double& value : covered)
        value /= double(strandsPerCell(width)) * double(kStrandLength) * double(width);
    return covered;
}

} // namespace

TEST_CASE("hair: mean transmittance of a layer and of stacked layers")
{
    constexpr std::uint32_t kSide = 96;
    const double samples = 4.0 * kSide * kSide;
    const auto check = [&](float alpha, std::uint32_t count) {
        HairRenderSettings settings = plainSettings(kSide);
        settings.alpha = alpha;
        const HairFrame frame = renderHair(test::context(), layers(count, float(kSide)), nullptr,
                                           pixelCamera(kSide), settings);
        const double expected = std::pow(1.0 - double(alpha), double(count));
        // Samples as if independent: k-of-4 masks only lower the variance. RGBA16F holds 0 and 1
        // exactly.
        const double error = std::sqrt(expected * (1.0 - expected) / samples);
        CAPTURE(alpha);
        CAPTURE(count);
        CHECK(std::abs(meanTransmittance(frame.hair) - expected) <= 4.0 * error + 1e-6);
    };
    for (const float alpha : {0.0f, 0.05f, 0.1f, 0.25f, 0.5f, 0.75f, 1.0f})
        check(alpha, 1);
    for (const std::uint32_t count : {2u, 4u, 8u, 16u})
        for (const float alpha : {0.05f, 0.1f, 0.25f})
            check(alpha, count);
}

TEST_CASE("hair: expected coverage of thin strands at 16 angles")
{
    struct Case
    {
        float width;
        std::uint32_t frames; // the thinner, the fewer samples it hits per frame
    };
    for (const Case c :
         {Case{0.02f, 240}, Case{0.1f, 40}, Case{0.5f, 8}, Case{1.0f, 4}, Case{3.0f, 4}}) {
        HairRenderSettings settings = plainSettings(kGridSide);
        settings.frames = c.frames;
        settings.exactCoverage = true;
        const HairFrame frame = renderHair(test::context(), strandGrid(c.width), nullptr,
                                           pixelCamera(kGridSide), settings);
        const std::vector<double> noisy = relativeCoverage(frame.hair, false, c.width);
        const std::vector<double> exact = relativeCoverage(frame.exactTransmittance, true, c.width);
        for (std::size_t angle = 0; angle < noisy.size(); ++angle) {
            CAPTURE(c.width);
            CAPTURE(angle);
            CHECK(std::abs(noisy[angle] - 1.0) <= 0.02);
            CHECK(std::abs(exact[angle] - 1.0) <= 0.02);
        }
    }
}

TEST_CASE("hair: true-width strands converge to the same coverage")
{
    constexpr float kWidth = 0.25f;
    HairRenderSettings settings = plainSettings(kGridSide);
    settings.mode = HairMode::Reference;
    settings.frames = 32;
    const HairFrame frame =
        renderHair(test::context(), strandGrid(kWidth), nullptr, pixelCamera(kGridSide), settings);
    // One angle's samples may fall between fine strands together: 3 % where the mean of all is 1 %.
    double mean = 0.0;
    for (const double value : relativeCoverage(frame.hair, false, kWidth)) {
        CHECK(std::abs(value - 1.0) <= 0.03);
        mean += value / 16.0;
    }
    CHECK(std::abs(mean - 1.0) <= 0.01);
}

TEST_CASE("hair: exact coverage multiplies layers")
{
    constexpr std::uint32_t kSide = 32;
    HairRenderSettings settings = plainSettings(kSide);
    settings.exactCoverage = true;
    settings.alpha = 0.25f;
    for (const std::uint32_t count : {1u, 4u, 16u}) {
        const HairFrame frame = renderHair(test::context(), layers(count, float(kSide)), nullptr,
                                           pixelCamera(kSide), settings);
        const double expected = std::pow(0.75, double(count));
        for (const glm::vec4& pixel : frame.exactTransmittance.pixels)
            // Every product rounds by up to 2^-24.
            REQUIRE(std::abs(double(pixel.x) - expected) <= expected * double(count) * 0x1p-23);
    }
}

TEST_CASE("hair: the exact coverage corrects the noisy one")
{
    constexpr std::uint32_t kSide = 48;
    HairRenderSettings settings = plainSettings(kSide);
    settings.alpha = 0.3f;
    settings.alphaCorrection = true;
    const HairFrame frame =
        renderHair(test::context(), layers(3, float(kSide)), nullptr, pixelCamera(kSide), settings);
    for (std::size_t i = 0; i < frame.hair.pixels.size(); ++i) {
        const float exact = frame.exactTransmittance.pixels[i].x;
        const bool touched = frame.hair.pixels[i].w < 1.0f; // by any of the four samples
        if (touched)
            REQUIRE(frame.hair.pixels[i].w == exact);
    }
}

TEST_CASE("hair: opaque triangles hide what is behind them")
{
    constexpr std::uint32_t kSide = 64;
    Scene scene; // the left half of the picture, between the first and the second strand
    const float far = 2.0f * float(kSide);
    for (const glm::vec2 p :
         {glm::vec2(-far, -far), glm::vec2(0.0f, -far), glm::vec2(0.0f, far), glm::vec2(-far, far)})
        scene.vertices.push_back({.position = {p, 0.0f}});
    scene.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.triangleMaterials = {0, 0};
    scene.materials.push_back({.name = "wall", .baseColor = {0.2f, 0.4f, 0.6f, 1.0f}});
    HairStrands hair;
    addStrand(hair, {{-30.0f, 10.0f, 4.0f}, {30.0f, 10.0f, 4.0f}}, 4.0f);     // before
    addStrand(hair, {{-30.0f, -10.0f, -4.0f}, {30.0f, -10.0f, -4.0f}}, 4.0f); // behind
    HairRenderSettings settings = plainSettings(kSide);
    settings.exactCoverage = true;
    const HairFrame frame = renderHair(test::context(), hair, &scene, pixelCamera(kSide), settings);
    const auto check = [&](std::uint32_t x, std::uint32_t y, float transmittance) {
        CAPTURE(x);
        CAPTURE(y);
        CHECK(frame.hair.at(x, y).w == transmittance);
        CHECK(frame.exactTransmittance.at(x, y).x == transmittance);
    };
    check(16, 22, 0.0f);
    check(48, 22, 0.0f);
    check(16, 42, 1.0f); // hidden
    check(48, 42, 0.0f);
    // The wall is shaded: bluer than red; the open background keeps its constant colour.
    CHECK(frame.radiance.at(16, 42).z > 2.0f * frame.radiance.at(16, 42).x);
    CHECK(frame.radiance.at(60, 2).x == doctest::Approx(settings.backgroundColor.x).epsilon(1e-3));
}

TEST_CASE("hair: a background picture shows through by the transmittance")
{
    constexpr std::uint32_t kSide = 32;
    const CpuImage background(kSide, kSide, glm::vec4(2.0f, 1.0f, 0.5f, 1.0f));
    HairRenderSettings settings = plainSettings(kSide);
    settings.alpha = 0.5f;
    settings.ambient = glm::vec3(0.0f);
    settings.keyIrradiance = glm::vec3(0.0f); // black hair
    settings.background = &background;
    const HairFrame frame =
        renderHair(test::context(), layers(1, float(kSide)), nullptr, pixelCamera(kSide), settings);
    for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i)
        REQUIRE(frame.radiance.pixels[i].x == frame.hair.pixels[i].w * 2.0f);
}

TEST_CASE("hair: a layer shadows what lies behind it as seen from the light")
{
    constexpr std::uint32_t kSide = 32;
    HairStrands hair = layers(1, float(kSide));
    addStrand(hair, {{-10.0f, 0.0f, -40.0f}, {10.0f, 0.0f, -40.0f}}, 2.0f);
    HairRenderSettings settings = plainSettings(kSide);
    settings.shadowSize = 128;
    settings.keyDirection = {0.0f, 0.0f, 1.0f};
    settings.alpha = 0.5f;
    const std::vector<gpu::HairLight> lights = hairLights(hair, nullptr, settings);
    Context& context = test::context();
    HairBuffers buffers = uploadHair(context, hair, nullptr, lights, 1);
    RenderGraph graph(context);
    HairView view;
    view.eye = {0.0f, 0.0f, 100.0f};
    const BufferId shaded = addHairShadingPasses(graph, buffers, lights, {true}, view, settings);
    graph.output(shaded);
    graph.run();
    const std::vector<glm::vec4> values = graph.read<glm::vec4>(shaded);
    CHECK(values[0].w == 1.0f);
    // 36 samples of 1/2: 99.99 % lie within 4 standard deviations of 0.083.
    CHECK(std::abs(values[2].w - 0.5f) <= 0.34f);
    CHECK(std::abs(values[3].w - 0.5f) <= 0.34f);
}

TEST_CASE("hair: the same frame twice is the same bytes, another frame is not")
{
    const HairStrands hair = strandGrid(0.4f);
    HairRenderSettings settings = plainSettings(kGridSide);
    settings.shadows = true;
    settings.shadowSize = 256;
    const auto render = [&] {
        return renderHair(test::context(), hair, nullptr, pixelCamera(kGridSide), settings)
            .radiance;
    };
    const CpuImage first = render();
    const CpuImage second = render();
    REQUIRE(first.pixels.size() == second.pixels.size());
    const std::size_t bytes = first.pixels.size() * sizeof(glm::vec4);
    CHECK(std::memcmp(first.pixels.data(), second.pixels.data(), bytes) == 0);
    settings.frameIndex = 1;
    CHECK(std::memcmp(first.pixels.data(), render().pixels.data(), bytes) != 0);
}

TEST_CASE("hair: without strands there is no pass and no pipeline")
{
    Context context = Context::headless({.validation = true});
    HairRenderSettings settings = plainSettings(16);
    const HairFrame frame = renderHair(context, HairStrands{}, nullptr, pixelCamera(16), settings);
    CHECK(context.pipelinesCreated() == 0);
    CHECK(frame.timings.empty());
    CHECK(frame.drawnSegments == 0);
    REQUIRE(frame.skipped.size() == 1);
    CHECK(frame.skipped[0].find("no strand") != std::string::npos);
    CHECK(frame.radiance.at(3, 3).x == settings.backgroundColor.x);
    CHECK(frame.hair.at(3, 3).w == 1.0f);
}

TEST_CASE("hair: every second strand twice as wide covers as much")
{
    HairRenderSettings settings = plainSettings(kGridSide);
    settings.exactCoverage = true;
    settings.lod = 2;
    const HairFrame frame =
        renderHair(test::context(), strandGrid(0.2f), nullptr, pixelCamera(kGridSide), settings);
    CHECK(frame.drawnStrands == kCells * kCells * std::uint32_t(strandsPerCell(0.2f)) / 2);
    double mean = 0.0;
    for (const double value : relativeCoverage(frame.exactTransmittance, true, 0.2f))
        mean += value / 16.0;
    CHECK(std::abs(mean - 1.0) <= 0.02); // as for all strands
}

TEST_CASE("hair: settings out of range are refused with their value")
{
    const HairStrands hair = layers(1, 8.0f);
    HairRenderSettings settings = plainSettings(8);
    settings.alpha = 1.5f;
    CHECK_THROWS_WITH_AS(renderHair(test::context(), hair, nullptr, pixelCamera(8), settings),
                         doctest::Contains("1.5"), Error);
    settings = plainSettings(8);
    settings.width = 0;
    CHECK_THROWS_AS(renderHair(test::context(), hair, nullptr, pixelCamera(8), settings), Error);
}
