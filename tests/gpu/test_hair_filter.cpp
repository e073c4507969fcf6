// The hair filter against its parts in double: planes, network, kernel, composite; and that what no
// strand touches stays as it is.
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include <doctest/doctest.h>

#include "compute_nn/reference/kernel_filter.hpp"
#include "compute_nn/reference/networks.hpp"
#include "engine/base/error.hpp"
#include "passes/hair_blend.hpp"
#include "passes/hair_filter.hpp"
#include "passes/hair_network.hpp"
#include "tests/gpu/hair_cases.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

constexpr std::uint32_t kWidth = 45, kHeight = 70; // neither is a multiple of 8

// Strands in the upper left of the picture; the rest is empty.
HairStrands someStrands()
{
    HairStrands hair;
    for (int i = 0; i < 24; ++i) {
        const float x = -20.0f + 0.9f * float(i), tilt = float(i % 5) - 2.0f;
        addStrand(hair, {{x, 30.0f, 0.0f}, {x + tilt, 12.0f, 3.0f}, {x - tilt, -2.0f, 0.0f}}, 0.4f);
    }
    for (std::size_t i = 0; i < hair.colors.size(); ++i)
        hair.colors[i] = {0.8f, 0.3f + 0.01f * float(i % 40), 0.1f};
    return hair;
}

HairNetwork someNetwork(const UNetDesc& net)
{
    return {net, Parameters(context(), net.parameters(), 17)};
}

struct Filtered
{
    CpuImage blended, filtered, radiance;
    std::vector<float> planes; // whole picture, dense
};

// A picture of the background's size.
Filtered filter(HairNetwork& network, const HairFilterSettings& settings,
                const CpuImage& background, const HairStrands& hair = someStrands(),
                bool halves = false)
{
    const std::uint32_t width = background.width, height = background.height;
    const Camera camera = pixelCamera(height);
    HairRenderSettings render = plainSettings(height);
    render.width = width;
    const std::vector<gpu::HairLight> lights = hairLights(hair, nullptr, render);
    HairBuffers buffers = uploadHair(context(), hair, nullptr, lights, 1);
    HairView view;
    view.viewProjection =
        cameraViewProjection(camera, width, height, hairDepthRange(hair, nullptr, camera));
    view.eye = camera.eye;
    view.width = width;
    view.height = height;
    const ImageDesc desc{width, height, 1, Format::RGBA32F, 1};
    Image filtered(context(), desc, "filtered"), radiance(context(), desc, "radiance");
    radiance.upload(background);

    RenderGraph graph(context());
    const BufferId shaded = addHairShadingPasses(graph, buffers, lights, {false}, view, render);
    HairFilterInput input;
    input.samples = addHairStrandsPass(graph, buffers, shaded, view, render, 1, false, true);
    input.depth = hairDepthScale(hair, camera);
    input.blended =
        addHairBlendPass(graph, buffers, shaded, view, addHairCutsPass(graph, input.samples));
    const ParameterIds weights(graph, network.parameters);
    const HairComposite over{graph.importImage(filtered), graph.importImage(radiance)};
    std::optional<HalfGuard> guard;
    HairFilterSettings with = settings;
    if (halves)
        with.halves = &guard.emplace(graph);
    addHairFilterPasses(graph, network.net, weights, input, over, with);
    if (guard)
        guard->output(graph);
    const TensorId planes =
        addHairInputPass(graph, input.samples, input.blended, input.depth,
                         createTensor(graph, "planes", hairInputDesc(width, height)));
    graph.output(input.blended);
    graph.output(planes.buffer);
    graph.run();
    if (guard)
        guard->check(graph);
    CHECK_EQ(context().validationMessages(), 0);
    return {graph.read(input.blended), filtered.download(), radiance.download(),
            graph.read<float>(planes.buffer)};
}

bool sameBytes(const CpuImage& a, const CpuImage& b)
{
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec4)) == 0;
}

CpuImage gradient(std::uint32_t width = kWidth, std::uint32_t height = kHeight)
{
    CpuImage image(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            image.at(x, y) = {0.1f * float(x), 0.05f * float(y), 0.3f, 1.0f};
    return image;
}

// What the filter shows at a pixel, from the network's output in double.
glm::dvec4 expectedHair(const Filtered& f, const TensorDesc& desc, const std::vector<double>& y,
                        std::uint32_t px, std::uint32_t py)
{
    const auto out = [&](std::uint32_t channel) {
        return y[(std::size_t(channel) * desc.h + py) * desc.w + px];
    };
    std::array<double, 9> logits{};
    std::array<bool, 9> inside{};
    for (std::uint32_t k = 0; k < 9; ++k) {
        logits[k] = out(gpu::kHairOutLogits + k);
        inside[k] = px + k % 3 - 1 < kWidth && py + k / 3 - 1 < kHeight; // wraps below 0
    }
    const auto weights = reference::filterWeights<double>(logits, inside);
    glm::dvec3 color(0.0);
    for (std::uint32_t k = 0; k < 9; ++k)
        if (inside[k])
            color += weights[k] * glm::dvec3(f.blended.at(px + k % 3 - 1, py + k / 3 - 1));
    const glm::dvec4 mean(f.blended.at(px, py));
    const double near = glm::dot(glm::dvec3(mean), glm::dvec3(0.2126, 0.7152, 0.0722));
    const double brightness =
        std::clamp(std::expm1(std::log1p(near) + out(gpu::kHairOutBrightness)),
                   gpu::kHairLeastBrightness * near, gpu::kHairMostBrightness * near);
    const double size = glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722));
    const glm::dvec3 hair = size > 0.0 ? color * (brightness / size) : glm::dvec3(brightness);
    const double transmittance = std::clamp(mean.w + out(gpu::kHairOutTransmittance), 0.0, 1.0);
    return {hair, 1.0 - transmittance};
}

} // namespace

TEST_CASE("hair filter: the picture is what planes, network and kernel give in double")
{
    HairNetwork network = someNetwork(hairUNet(HairUNetSize::Small));
    const CpuImage background = gradient();
    const Filtered f = filter(network, {}, background);
    const TensorDesc desc = hairInputDesc(kWidth, kHeight);
    const std::vector<float> w = network.net.parameters().initialValues(17);
    const std::vector<double> target(std::size_t(gpu::kHairOutputs) * desc.pixels(), 0.0);
    const std::vector<double> y =
        reference::unet<double>(network.net, std::vector<double>(w.begin(), w.end()), desc,
                                std::vector<double>(f.planes.begin(), f.planes.end()), target)
            .output;
    std::uint32_t touched = 0;
    double worst = 0.0;
    for (std::uint32_t py = 0; py < kHeight; ++py)
        for (std::uint32_t px = 0; px < kWidth; ++px) {
            if (f.blended.at(px, py).w == 1.0f) {
                REQUIRE(f.radiance.at(px, py) == background.at(px, py));
                REQUIRE(f.filtered.at(px, py) == glm::vec4(0.0f));
                continue;
            }
            ++touched;
            const glm::dvec4 hair = expectedHair(f, desc, y, px, py);
            const glm::dvec3 shown =
                glm::dvec3(hair) + (1.0 - hair.w) * glm::dvec3(background.at(px, py));
            const double scale = 1.0 + glm::length(hair);
            worst = std::max(worst, glm::length(glm::dvec4(f.filtered.at(px, py)) - hair) / scale);
            worst = std::max(worst, glm::length(glm::dvec3(f.radiance.at(px, py)) - shown) / scale);
        }
    CHECK_GT(touched, 300);
    CHECK_LT(touched, kWidth * kHeight / 2);
    CHECK_LE(worst, 1e-4); // fp32 through seven layers, then an exponential
}

TEST_CASE("hair filter: bands of rows give the bits of the whole picture")
{
    for (const HairUNetSize size :
         {HairUNetSize::Small, HairUNetSize::Large}) { // without, with a head
        HairNetwork network = someNetwork(hairUNet(size));
        const Filtered whole = filter(network, {}, gradient());
        for (const std::uint32_t rows : {8u, 24u, 40u}) {
            CAPTURE(rows);
            const Filtered bands = filter(network, {.bandRows = rows}, gradient());
            CHECK(sameBytes(bands.radiance, whole.radiance));
            CHECK(sameBytes(bands.filtered, whole.filtered));
        }
    }
}

TEST_CASE("hair filter: skipping tiles changes no bit, whatever the hair covers")
{
    constexpr std::uint32_t kWide = 173,
                            kTall = 91; // five tiles across at full size, one at the coarsest
    HairStrands corner, line, everywhere, outside;
    addStrand(corner, {{-86.0f, 45.0f, 0.0f}, {-83.0f, 41.0f, 0.0f}}, 0.5f);
    addStrand(line, {{-80.0f, -44.0f, 0.0f}, {80.0f, 44.0f, 0.0f}}, 0.5f);
    addStrand(everywhere, {{-200.0f, 0.0f, 0.0f}, {200.0f, 0.0f, 0.0f}}, 100.0f);
    addStrand(outside, {{0.0f, 400.0f, 0.0f}, {10.0f, 410.0f, 0.0f}}, 0.5f);
    for (const HairStrands& hair : {corner, line, everywhere, outside, someStrands()})
        for (const std::uint32_t rows : {0u, 32u}) {
            CAPTURE(rows);
            HairNetwork network =
                someNetwork(hairUNet(rows == 0 ? HairUNetSize::Small : HairUNetSize::Large));
            const CpuImage background = gradient(kWide, kTall);
            const Filtered dense = filter(network, {.skipTiles = false}, background, hair);
            const Filtered tiles = filter(network, {.bandRows = rows}, background, hair);
            CHECK(sameBytes(tiles.filtered, dense.filtered));
            CHECK(sameBytes(tiles.radiance, dense.radiance));
        }
}

TEST_CASE("hair filter: a picture by a network, twice the same, and what it refuses")
{
    HairNetwork network = someNetwork(hairUNet(HairUNetSize::Small));
    HairRenderSettings settings = plainSettings(40);
    settings.filter = HairFilter::UNet;
    const auto render = [&] {
        return renderHair(context(), someStrands(), nullptr, pixelCamera(40), settings);
    };
    CHECK_THROWS_WITH_AS((void)render(), doctest::Contains("no network"), Error);
    settings.network = &network;
    const HairFrame frame = render();
    CHECK(sameBytes(frame.radiance, render().radiance));
    CHECK(frame.radiance.at(39, 39).x == doctest::Approx(settings.backgroundColor.x));
    CHECK(frame.hair.at(39, 39) == glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    REQUIRE_EQ(frame.tiles.size(), 7);        // three down, three up, the last
    CHECK_EQ(frame.tiles.front().all, 3 * 3); // 20x20 pixels
    CHECK_EQ(frame.tiles.back().all, 5 * 5);
    std::uint32_t touched = 0; // what the last layer is for
    for (std::uint32_t tile = 0; tile < 25; ++tile) {
        bool hair = false;
        for (std::uint32_t i = 0; i < 64; ++i)
            hair |=
                frame.exactTransmittance.at(tile % 5 * 8 + i % 8, tile / 5 * 8 + i / 8).x < 1.0f;
        touched += hair ? 1 : 0;
    }
    CHECK_EQ(frame.tiles.back().active, touched);
    CHECK_LT(touched, 25);
    settings.frames = 2;
    CHECK_THROWS_WITH_AS((void)render(), doctest::Contains("four samples"), Error);
    settings.frames = 1;
    HairNetwork wrong = someNetwork(UNetDesc{});
    settings.network = &wrong;
    CHECK_THROWS_WITH_AS((void)render(), doctest::Contains("24 planes to 3"), Error);
}

TEST_CASE("hair filter: activations as halves change the picture by their rounding, tiles no bit")
{
    if (!context().device().missingForHalves.empty()) {
        MESSAGE("no halves: the device lacks " << context().device().missingForHalves);
        return;
    }
    HairNetwork network = someNetwork(hairUNet(HairUNetSize::Small));
    const HairStrands hair = someStrands();
    const CpuImage floats = filter(network, {}, gradient(), hair).radiance;
    for (const bool fuse : {false, true}) { // fetched, the input alone is not rounded
        CAPTURE(fuse);
        const auto stored = [&](HairFilterSettings settings) {
            settings.fuseFetch = fuse;
            return filter(network, settings, gradient(), hair, true).radiance;
        };
        const CpuImage halves = stored({});
        CHECK(sameBytes(halves, stored({.bandRows = 24})));
        CHECK(sameBytes(halves, stored({.skipTiles = false})));
        // Each stored value is off by up to 2^-10 of itself, those of a pixel on some ten ways to
        // it.
        double difference = 0.0, size = 0.0;
        for (std::size_t i = 0; i < floats.pixels.size(); ++i) {
            const glm::dvec3 a(floats.pixels[i]), b(halves.pixels[i]);
            difference += glm::dot(a - b, a - b);
            size += glm::dot(a, a);
        }
        CHECK_LE(std::sqrt(difference / size), 10.0 * 0x1p-10);
        CHECK_GT(difference, 0.0);
    }
}

TEST_CASE("hair filter: layers that fetch the input give the bits of those that read its planes")
{
    const HairStrands hair = someStrands();
    for (const HairUNetSize size :
         {HairUNetSize::Small, HairUNetSize::Medium, HairUNetSize::Large}) { // the last with a head
        CAPTURE(int(size));
        HairNetwork network = someNetwork(hairUNet(size));
        const Filtered planes = filter(network, {.fuseFetch = false}, gradient(), hair);
        for (const HairFilterSettings& settings :
             {HairFilterSettings{.skipTiles = false, .fuseFetch = true},
              HairFilterSettings{.fuseFetch = true},
              HairFilterSettings{.bandRows = 24, .fuseFetch = true}}) {
            CAPTURE(settings.skipTiles);
            CAPTURE(settings.bandRows);
            const Filtered fetched = filter(network, settings, gradient(), hair);
            CHECK(sameBytes(fetched.filtered, planes.filtered));
            CHECK(sameBytes(fetched.radiance, planes.radiance));
        }
    }
}
