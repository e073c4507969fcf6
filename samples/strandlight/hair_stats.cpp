#include "samples/strandlight/hair_stats.hpp"

#include <cstdio>

namespace strandlight::cli {

namespace {

double allWork(const HairFrame& frame)
{
    double work = 0.0;
    for (const HairTileCount& tiles : frame.tiles)
        work += tiles.work;
    return work;
}

} // namespace

double totalMilliseconds(const HairFrame& frame)
{
    double total = 0.0;
    for (const PassTiming& timing : frame.timings)
        total += timing.milliseconds;
    return total;
}

double savedWork(const HairFrame& frame)
{
    double saved = 0.0;
    for (const HairTileCount& tiles : frame.tiles)
        saved += tiles.work * (1.0 - double(tiles.active) / tiles.all);
    return frame.tiles.empty() ? 0.0 : saved / allWork(frame);
}

void printHairStats(const Context& context, const HairStrands& hair, const HairFrame& frame)
{
    std::printf("device    %s\n", context.device().name.c_str());
    std::printf("hair      %u strands, %u segments drawn, level of detail %u\n", frame.drawnStrands,
                frame.drawnSegments, frame.lod);
    for (const PassTiming& timing : frame.timings)
        std::printf("pass      %-24s %9.3f ms\n", timing.pass.c_str(), timing.milliseconds);
    for (const HairTileCount& tiles : frame.tiles)
        std::printf("tiles     %-6s level %u %9u of %u, %.1f %%\n", tiles.layer.c_str(),
                    tiles.level, tiles.active, tiles.all, 100.0 * tiles.active / tiles.all);
    if (!frame.tiles.empty())
        std::printf("saved     %.1f %% of the network's %.3f G multiply-adds\n",
                    100.0 * savedWork(frame), 1e-9 * allWork(frame));
    for (const std::string& pass : frame.skipped)
        std::printf("culled    %s\n", pass.c_str());
    std::printf("together  %.3f ms, device memory %s\n", totalMilliseconds(frame),
                bytesText(context.peakBytesAllocated()).c_str());
    std::printf("skipped   %zu passes, %u of %u strands (level of detail), %u of %u blocks of 8x8 "
                "pixels (no hair)\n",
                frame.skipped.size(), hair.strandCount() - frame.drawnStrands, hair.strandCount(),
                frame.emptyBlocks, frame.blocks);
}

Json describeTiles(const HairFrame& frame)
{
    Json json = Json::array();
    for (const HairTileCount& tiles : frame.tiles)
        json.push_back({{"layer", tiles.layer},
                        {"level", tiles.level},
                        {"active", tiles.active},
                        {"all", tiles.all},
                        {"multiply_adds", tiles.work}});
    return json;
}

} // namespace strandlight::cli
