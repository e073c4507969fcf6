#include "passes/sg_field.hpp"

#include <bit>
#include <map>
#include <tuple>

#include "shaders/shared/sg.h"

namespace strandlight {

std::uint64_t SgField::keptCount() const
{
    if (kept.empty())
        return lobes.size();
    std::uint64_t count = 0;
    for (const std::uint32_t mask : kept)
        count += std::uint64_t(std::popcount(mask));
    return count;
}

LobeTiles lobeTiles(const Atlas& atlas, std::uint32_t tileSize)
{
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> known;
    LobeTiles tiles;
    tiles.tileOf.reserve(atlas.texels.size());
    for (const AtlasTexel& texel : atlas.texels) {
        const auto place = std::tuple(texel.chart, texel.x / tileSize, texel.y / tileSize);
        const auto [found, isNew] = known.try_emplace(place, tiles.count);
        tiles.count += isNew ? 1 : 0;
        tiles.tileOf.push_back(found->second);
    }
    return tiles;
}

SgLobe interpolateLobe(const SgField& field, const glm::uvec4& texels, const glm::vec4& weights,
                       std::uint32_t lobe)
{
    SgLobe sum{.axis = glm::vec3(0.0f)};
    float present = 0.0f;
    for (int c = 0; c < 4; ++c) {
        if ((field.keptBy(texels[c]) >> lobe & 1u) == 0u)
            continue;
        const SgLobe& corner = field.lobes[std::size_t(texels[c]) * field.lobeCount + lobe];
        sum.axis += weights[c] * corner.axis;
        sum.logSharpness += weights[c] * corner.logSharpness;
        sum.amplitude += weights[c] * corner.amplitude;
        present += weights[c];
    }
    sum.axis = gpu::safeNormalize(sum.axis, glm::vec3(0.0f, 0.0f, 1.0f));
    sum.logSharpness /= present > 0.0f ? present : 1.0f;
    return sum;
}

} // namespace strandlight
