#include "passes/hair_counts.hpp"

#include <algorithm>

namespace strandlight {

void addHairTimings(std::vector<PassTiming>& sum, std::span<const PassTiming> more)
{
    for (const PassTiming& timing : more) {
        const auto same = std::find_if(sum.begin(), sum.end(),
                                       [&](const PassTiming& t) { return t.pass == timing.pass; });
        if (same == sum.end())
            sum.push_back(timing);
        else
            same->milliseconds += timing.milliseconds;
    }
}

void countHairBlocks(HairFrame& frame)
{
    constexpr std::uint32_t kSide = 8;
    const CpuImage& exact = frame.exactTransmittance;
    const std::uint32_t across = (exact.width + kSide - 1) / kSide;
    std::vector<std::uint8_t> touched(std::size_t(across) * ((exact.height + kSide - 1) / kSide));
    for (std::uint32_t y = 0; y < exact.height; ++y)
        for (std::uint32_t x = 0; x < exact.width; ++x)
            if (exact.at(x, y).x < 1.0f)
                touched[std::size_t(y / kSide) * across + x / kSide] = 1;
    frame.blocks = std::uint32_t(touched.size());
    frame.emptyBlocks = std::uint32_t(std::count(touched.begin(), touched.end(), 0));
}

std::vector<HairTileCount> countHairTiles(const RenderGraph& graph,
                                          std::span<const LayerTiles> layers)
{
    std::vector<HairTileCount> counts;
    for (const LayerTiles& layer : layers) {
        auto same = std::find_if(counts.begin(), counts.end(),
                                 [&](const HairTileCount& t) { return t.layer == layer.layer; });
        if (same == counts.end())
            same = counts.insert(same, HairTileCount{layer.layer, layer.level});
        same->active += graph.read<std::uint32_t>(layer.arguments).front();
        same->all += layer.all;
        same->work += double(layer.work);
    }
    return counts;
}

} // namespace strandlight
