// Strands blended in slices of depth: against a twin that adds up the same areas in double, and
// close to strands sorted by depth, which it stands for.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "passes/hair_blend.hpp"
#include "shaders/shared/hair_coverage.h"
#include "tests/gpu/hair_cases.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

constexpr std::uint32_t kSide = 48, kStrands = 160;
constexpr float kWidth = 0.7f, kAlpha = 0.8f;

// A straight strand across the whole picture, at one depth.
struct Line
{
    glm::dvec2 place, across; // pixels from the picture's middle, y down
    double depth = 0.0;
};

struct Blended
{
    std::vector<Line> lines;
    std::vector<glm::vec4> shaded; // [2 strands]
    CpuImage first, second, image; // cuts, and the blended picture
    std::vector<float> planes;
};

double hash01(std::uint32_t i, std::uint32_t k)
{
    return std::fmod(0.5 + 0.7548776662 * double(i) + 0.5698402910 * double(i * k), 1.0);
}

Blended blend()
{
    Blended b;
    HairStrands hair;
    const double eye = 4.0 * kSide;
    for (std::uint32_t i = 0; i < kStrands; ++i) {
        const double angle = 3.14159265 * hash01(i, 3), offset = 60.0 * (hash01(i, 7) - 0.5);
        const double z = -30.0 * hash01(i, 11);
        const double scale = (eye - z) / eye; // of lengths at z for one pixel
        const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
        const glm::dvec2 place = across * offset;
        const auto point = [&](double t) {
            const glm::dvec2 p = scale * (place + t * along);
            return glm::vec3(float(p.x), float(p.y), float(z));
        };
        addStrand(hair, {point(-80.0), point(80.0)}, float(0.5 * scale * kWidth));
        b.lines.push_back({{place.x, -place.y}, {across.x, -across.y}, eye - z});
        const float tone = float(hash01(i, 13));
        hair.colors[2 * i] =
            hair.colors[2 * i + 1] = {0.9f * tone + 0.05f, 0.9f - 0.8f * tone, 0.2f};
    }
    HairRenderSettings settings = plainSettings(kSide);
    const std::vector<gpu::HairLight> lights = hairLights(hair, nullptr, settings);
    HairBuffers buffers = uploadHair(context(), hair, nullptr, lights, 1);
    const Camera camera = pixelCamera(kSide);
    HairView view;
    view.viewProjection =
        cameraViewProjection(camera, kSide, kSide, hairDepthRange(hair, nullptr, camera));
    view.eye = camera.eye;
    view.width = view.height = kSide;
    view.alpha = kAlpha;
    RenderGraph graph(context());
    const BufferId shaded = addHairShadingPasses(graph, buffers, lights, {false}, view, settings);
    const HairSampleIds samples =
        addHairStrandsPass(graph, buffers, shaded, view, settings, 1, false, true);
    const HairCuts cuts = addHairCutsPass(graph, samples);
    const ImageId image = addHairBlendPass(graph, buffers, shaded, view, cuts);
    const TensorId planes =
        addHairInputPass(graph, samples, image, {0.0f, 1.0f},
                         createTensor(graph, "planes", hairInputDesc(kSide, kSide)));
    for (const ImageId id : {cuts.first, cuts.second, image})
        graph.output(id);
    graph.output(planes.buffer);
    graph.run();
    CHECK_EQ(context().validationMessages(), 0);
    b.shaded = buffers.shaded.downloadAs<glm::vec4>();
    b.first = graph.read(cuts.first);
    b.second = graph.read(cuts.second);
    b.image = graph.read(image);
    b.planes = graph.read<float>(planes.buffer);
    return b;
}

const Blended& blended()
{
    static const Blended once = blend();
    return once;
}

std::array<double, 8> cutsAt(const Blended& b, std::uint32_t x, std::uint32_t y)
{
    const glm::vec4 a = b.first.at(x, y), c = b.second.at(x, y);
    return {a.x, a.y, a.z, a.w, c.x, c.y, c.z, c.w};
}

struct Fragment
{
    double alpha, depth;
    glm::dvec3 radiance;
    glm::dvec4 quarters; // alpha in each of the pixel's
};

std::vector<Fragment> fragmentsAt(const Blended& b, std::uint32_t x, std::uint32_t y)
{
    std::vector<Fragment> fragments;
    const glm::dvec2 middle(double(x) + 0.5 - 0.5 * kSide, double(y) + 0.5 - 0.5 * kSide);
    for (std::size_t i = 0; i < b.lines.size(); ++i) {
        const Line& line = b.lines[i];
        const glm::vec2 direction(float(line.across.y), -float(line.across.x));
        const double distance = glm::dot(middle - line.place, line.across);
        // Both ends are shaded alike: the strand is straight, the camera far away.
        const glm::dvec3 radiance =
            0.5 * (glm::dvec3(b.shaded[2 * i]) + glm::dvec3(b.shaded[2 * i + 1]));
        // Straight across the picture: along it, a strip that holds the pixel.
        const glm::dvec4 quarters =
            double(kAlpha) *
            glm::dvec4(gpu::hairQuarterAreas(kWidth, float(distance), 160.0f, 0.0f, direction));
        const double alpha = 0.25 * (quarters.x + quarters.y + quarters.z + quarters.w);
        if (alpha > 0.0)
            fragments.push_back({alpha, line.depth, radiance, quarters});
    }
    return fragments;
}

// Premultiplied radiance, transmittance; fragments of the same slice as one. What shows is as much
// as the quarters of the pixel hide.
template <class SliceOf>
glm::dvec4 composite(std::vector<Fragment> fragments, const SliceOf& sliceOf)
{
    std::sort(fragments.begin(), fragments.end(),
              [](const Fragment& a, const Fragment& c) { return a.depth < c.depth; });
    glm::dvec4 sum(0.0, 0.0, 0.0, 1.0);
    glm::dvec4 quarters(1.0);
    for (std::size_t i = 0; i < fragments.size();) {
        glm::dvec4 slice(0.0);
        const auto here = sliceOf(fragments[i]);
        for (; i < fragments.size() && sliceOf(fragments[i]) == here; ++i) {
            slice += -std::log1p(-fragments[i].alpha) * glm::dvec4(fragments[i].radiance, 1.0);
            quarters *= 1.0 - fragments[i].quarters;
        }
        const double through = std::exp(-slice.w);
        sum += glm::dvec4(glm::dvec3(slice) / slice.w * (sum.w * (1.0 - through)), 0.0);
        sum.w *= through;
    }
    if (fragments.empty())
        return sum;
    const double through = 0.25 * (quarters.x + quarters.y + quarters.z + quarters.w);
    return {glm::dvec3(sum) * ((1.0 - through) / (1.0 - sum.w)), through};
}

} // namespace

TEST_CASE("hair blend: slices end at quantiles of the samples around")
{
    const Blended& b = blended();
    const auto plane = [&](std::uint32_t index, std::uint32_t x, std::uint32_t y) {
        return b.planes[(std::size_t(index) * kSide + y) * kSide + x];
    };
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            std::vector<double> depths;
            for (const glm::ivec2 tap : {glm::ivec2(0, 0), glm::ivec2(-1, 0), glm::ivec2(1, 0),
                                         glm::ivec2(0, -1), glm::ivec2(0, 1)})
                for (std::uint32_t s = 0; s < 4; ++s) {
                    const auto px = std::uint32_t(std::clamp(int(x) + tap.x, 0, int(kSide) - 1));
                    const auto py = std::uint32_t(std::clamp(int(y) + tap.y, 0, int(kSide) - 1));
                    if (plane(8 + s, px, py) < 0.5f)
                        depths.push_back(double(plane(12 + s, px, py)));
                }
            std::sort(depths.begin(), depths.end());
            const auto cuts = cutsAt(b, x, y);
            for (std::size_t k = 0; k < cuts.size(); ++k) {
                const std::size_t rank =
                    ((k + 1) * depths.size() + gpu::kHairSlices / 2) / gpu::kHairSlices;
                const bool cut = k + 1 < gpu::kHairSlices && rank > 0 && rank < depths.size();
                CAPTURE(x);
                CAPTURE(y);
                CAPTURE(k);
                REQUIRE(cuts[k] ==
                        doctest::Approx(cut ? 0.5 * (depths[rank - 1] + depths[rank]) : 1e30)
                            .epsilon(1e-6));
            }
        }
}

TEST_CASE("hair blend: sums of overlapping strands are those of a twin in double")
{
    const Blended& b = blended();
    std::size_t most = 0;
    double worst = 0.0, mean = 0.0, worstTransmittance = 0.0, meanTransmittance = 0.0;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const std::vector<Fragment> fragments = fragmentsAt(b, x, y);
            most = std::max(most, fragments.size());
            const auto cuts = cutsAt(b, x, y);
            const glm::dvec4 expected = composite(fragments, [&](const Fragment& f) {
                return std::count_if(cuts.begin(), cuts.end(),
                                     [&](double cut) { return f.depth >= cut; });
            });
            const glm::dvec4 difference = glm::dvec4(b.image.at(x, y)) - expected;
            for (int c = 0; c < 3; ++c)
                worst = std::max(worst, std::abs(difference[c]) / (std::abs(expected[c]) + 0.05));
            mean += std::abs(difference.y) / (kSide * kSide);
            worstTransmittance = std::max(worstTransmittance, std::abs(difference.w));
            meanTransmittance += difference.w / (kSide * kSide);
            if (fragments.empty())
                REQUIRE(b.image.at(x, y) == glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
        }
    CHECK(most >= 12); // strands on top of each other
    MESSAGE("relative difference at worst "
            << worst << ", mean " << mean << "; of the transmittance " << worstTransmittance << ", "
            << meanTransmittance);
    // The device keeps a ribbon's corners to 1/256 of a pixel and sums as halves: each of a dozen
    // strands is off by up to 1/256 of a pixel, whichever way.
    CHECK(worst < 0.06);
    CHECK(mean < 4e-3);
    CHECK(worstTransmittance < 0.04);
    CHECK(std::abs(meanTransmittance) < 1e-3);
}

TEST_CASE("hair blend: slices come close to strands sorted by depth")
{
    const Blended& b = blended();
    double slices = 0.0, unsorted = 0.0;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const std::vector<Fragment> fragments = fragmentsAt(b, x, y);
            const glm::dvec4 sorted =
                composite(fragments, [](const Fragment& f) { return f.depth; });
            const glm::dvec4 mixed = composite(fragments, [](const Fragment&) { return 0; });
            const glm::dvec3 a = glm::dvec3(b.image.at(x, y)) - glm::dvec3(sorted);
            const glm::dvec3 c = glm::dvec3(mixed) - glm::dvec3(sorted);
            slices += glm::dot(a, a);
            unsorted += glm::dot(c, c);
        }
    MESSAGE("RMSE against sorted strands, over that of their unsorted mean: "
            << std::sqrt(slices / unsorted));
    CHECK(std::sqrt(slices / unsorted) < 0.3);
}

TEST_CASE("hair blend: strands without features are refused")
{
    RenderGraph graph(context());
    CHECK_THROWS_AS((void)addHairCutsPass(graph, HairSampleIds{}), Error);
}
