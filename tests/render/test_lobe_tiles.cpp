// Tiles that keep fewer lobes on the device: the same picture as with all of them, in fewer turns.
#include <bit>

#include <doctest/doctest.h>

#include "passes/savings.hpp"
#include "tests/render/square_scene.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

constexpr std::uint32_t kLobes = 16;
constexpr std::uint32_t kTile = 8; // of an atlas of 32: four tiles a side

// Quarters of the square keep 2, 4, 8 and 16 lobes, in turn; every lobe has one axis and sharpness
// everywhere, so that a dropped one is nothing but black.
SgBake tiledBake(const Scene& scene)
{
    SgBake bake;
    bake.atlas = buildAtlas(scene, {.resolution = 32});
    SgField& field = bake.radiance;
    field.lobeCount = kLobes;
    field.tileSize = kTile;
    for (const AtlasTexel& texel : bake.atlas.texels) {
        const std::uint32_t keep = 2u << (texel.x / kTile % 2 + 2 * (texel.y / kTile % 2));
        field.kept.push_back((keep < 32 ? (1u << keep) : 0u) - 1u);
        for (std::uint32_t k = 0; k < kLobes; ++k) {
            const float azimuth = 2.4f * float(k), height = (float(k) + 0.5f) / kLobes;
            const float radius = std::sqrt(1.0f - height * height);
            field.lobes.push_back(
                {.axis = {radius * std::cos(azimuth), radius * std::sin(azimuth), height},
                 .logSharpness = 0.3f * float(k),
                 .amplitude = glm::vec3(1.0f + float(k % 3), 1.0f, 0.5f)});
        }
    }
    return bake;
}

const Camera kAbove{
    .eye = {0.3f, 0.2f, 2.0f}, .target = glm::vec3(0.0f), .verticalFovDegrees = 40.0f};

} // namespace

TEST_CASE("lobe tiles: 2, 4, 8 or 16 lobes shade as all of them with the dropped ones black")
{
    Material material = metal(glm::vec3(0.8f, 0.6f, 0.3f), 0.3f);
    material.metallic = 0.5f; // diffuse and glossy
    const Scene scene = buildSquare(material);
    const SgBake bake = tiledBake(scene);
    REQUIRE(bakeSavings(bake).keptLobes < bakeSavings(bake).lobes / 2);
    const SgBake whole = withAllLobes(bake);
    for (const RenderView view :
         {RenderView::Final, RenderView::Diffuse, RenderView::Specular, RenderView::Lobes}) {
        const FrameResult tiled = render(scene, bake, kAbove, {.view = view});
        const FrameResult full = render(scene, whole, kAbove, {.view = view});
        CAPTURE(int(view));
        CHECK(tiled.textureBytes < full.textureBytes);
        // Weights of the corners that keep a lobe are summed apart: a few ulp of its axis, times
        // sharpness of up to 90.
        for (std::size_t i = 0; i < full.radiance.pixels.size(); ++i)
            checkClose(glm::vec3(tiled.radiance.pixels[i]), glm::vec3(full.radiance.pixels[i]),
                       1e-4);
    }
}

TEST_CASE("lobe tiles: shading takes one turn for each lobe that a corner keeps")
{
    const Scene scene = buildSquare(lambert(glm::vec3(0.5f)));
    const SgBake bake = tiledBake(scene);
    const auto turns = [&](const SgBake& lit) {
        const FrameResult frame =
            render(scene, lit, kAbove, {.supersample = 1, .view = RenderView::Count});
        std::vector<std::uint32_t> counts;
        for (const glm::vec4& pixel : frame.radiance.pixels)
            counts.push_back(std::uint32_t(pixel.x));
        return counts;
    };
    std::uint64_t sum = 0;
    std::uint32_t seen = 0; // bits: numbers that some pixel takes
    for (const std::uint32_t count : turns(bake)) {
        CHECK(std::has_single_bit(count)); // masks are nested: the most of four corners
        CHECK(count <= kLobes);
        seen |= count;
        sum += count;
    }
    CHECK(seen == (2u | 4u | 8u | 16u));
    for (const std::uint32_t count : turns(withAllLobes(bake)))
        CHECK(count == kLobes);
    CHECK(sum < 16u * 16u * kLobes * 6 / 10); // 7.5 of 16 but for borders
}
