#include "passes/savings.hpp"

#include <algorithm>
#include <vector>

namespace strandlight {
namespace {

void add(BakeSavings& sum, const Atlas& atlas, const SgField& field)
{
    sum.lobes += field.lobes.size();
    sum.keptLobes += field.keptCount();
    if (field.kept.empty())
        return;
    const LobeTiles tiles = lobeTiles(atlas, field.tileSize);
    std::vector<std::uint8_t> dark(tiles.count, 0);
    for (std::size_t t = 0; t < field.kept.size(); ++t)
        dark[tiles.tileOf[t]] = field.kept[t] == 0u ? 1 : 0;
    sum.tiles += tiles.count;
    sum.darkTiles += std::uint64_t(std::count(dark.begin(), dark.end(), 1));
}

void keepAll(SgField& field)
{
    for (std::size_t i = 0; i < field.lobes.size(); ++i)
        if ((field.keptBy(i / field.lobeCount) >> (i % field.lobeCount) & 1u) == 0u)
            field.lobes[i].amplitude = glm::vec3(0.0f);
    field.tileSize = 0;
    field.kept.clear();
}

} // namespace

BakeSavings bakeSavings(const SgBake& bake)
{
    BakeSavings sum;
    sum.places = std::uint64_t(bake.atlas.resolution) * bake.atlas.resolution;
    sum.texels = bake.atlas.texels.size();
    add(sum, bake.atlas, bake.radiance);
    if (bake.environment)
        add(sum, bake.atlas, *bake.environment);
    return sum;
}

SgBake withAllLobes(SgBake bake)
{
    keepAll(bake.radiance);
    if (bake.environment)
        keepAll(*bake.environment);
    return bake;
}

bool sendsLight(const Scene& scene)
{
    const auto& used = scene.triangleMaterials;
    return scene.environment || !scene.lights.empty() ||
           std::any_of(used.begin(), used.end(), [&](std::uint32_t material) {
               return scene.materials[material].emissive != glm::vec3(0.0f);
           });
}

} // namespace strandlight
