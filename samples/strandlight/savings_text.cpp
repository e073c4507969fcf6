#include "samples/strandlight/savings_text.hpp"

#include <cinttypes>
#include <cstdio>

namespace strandlight::cli {

namespace {

// Of lobes that are not stored: those of places without surface, and those that were dropped.
std::uint64_t savedBytes(const BakeSavings& s, std::uint64_t lobeBytes)
{
    if (s.texels == 0)
        return 0;
    return (s.lobes / s.texels * (s.places - s.texels) + s.lobes - s.keptLobes) * lobeBytes;
}

} // namespace

void printSavings(const BakeSavings& s, std::uint64_t lobeBytes)
{
    std::printf("skipped   %" PRIu64 " of %" PRIu64 " texels (no surface)", s.places - s.texels,
                s.places);
    if (s.tiles > 0)
        std::printf(", %" PRIu64 " of %" PRIu64 " lobes (dropped), %" PRIu64 " of %" PRIu64
                    " tiles (dark)",
                    s.lobes - s.keptLobes, s.lobes, s.darkTiles, s.tiles);
    std::printf("\n");
    std::printf("saved     %s of lobes, %s are kept\n", bytesText(savedBytes(s, lobeBytes)).c_str(),
                bytesText(s.keptLobes * lobeBytes).c_str());
}

void printSharing(const FrameResult& frame)
{
    std::printf("saved     %s of %s between passes by sharing memory\n",
                bytesText(frame.targetBytes - frame.arenaBytes).c_str(),
                bytesText(frame.targetBytes).c_str());
}

Json describeSavings(const BakeSavings& s, std::uint64_t lobeBytes)
{
    return {{"atlas_places", s.places},
            {"texels", s.texels},
            {"lobes", s.lobes},
            {"kept_lobes", s.keptLobes},
            {"tiles", s.tiles},
            {"dark_tiles", s.darkTiles},
            {"saved_bytes", savedBytes(s, lobeBytes)},
            {"kept_bytes", s.keptLobes * lobeBytes}};
}

} // namespace strandlight::cli
