// Which pixels a U-Net's layers need for one output pixel: the closed form against following every
// tap. Both directions are alike, so one is enough.
#include <doctest/doctest.h>

#include <set>

#include "compute_nn/conv_channels.hpp"
#include "compute_nn/unet_tiles.hpp"
#include "shaders/shared/minimal_filter.h"

using namespace strandlight;

namespace {

using Pixels = std::set<int>;

// Inputs of y[q] = sum w[k] x[stride q - padding + k].
Pixels readByConv(const Pixels& y, const Conv2dDesc& d)
{
    Pixels x;
    for (const int q : y)
        for (int k = 0; k < int(d.kernel.w); ++k)
            x.insert(q * int(d.stride.w) - int(d.padding.w) + k);
    return x;
}

// The same at points, where four neighbours are computed from all that one of them reads.
Pixels readByPoints(const Pixels& y, const Conv2dDesc& d)
{
    if (!fillsChannelTile(d.out))
        return readByConv(y, d);
    constexpr int kGroup = int(gpu::kMinimalTile);
    Pixels groups;
    for (const int q : y)
        for (int i = 0; i < kGroup; ++i)
            groups.insert(q - (q % kGroup + kGroup) % kGroup + i);
    return readByConv(groups, d);
}

// Inputs q of y[stride q - padding + k] += w[k] x[q].
Pixels readByTranspose(const Pixels& y, const ConvTranspose2dDesc& d)
{
    Pixels x;
    for (const int p : y)
        for (int k = 0; k < int(d.kernel.w); ++k) {
            const int q = p + int(d.padding.w) - k;
            if (q % int(d.stride.w) == 0)
                x.insert(q / int(d.stride.w));
        }
    return x;
}

struct Needs
{
    std::vector<Pixels> up, skip;
    Pixels input;
};

Needs followTaps(const UNetDesc& net, int p)
{
    Needs n;
    n.up.resize(net.levels());
    n.skip.resize(net.levels() + 1);
    n.up[0] = readByPoints({p}, net.last());
    for (std::uint32_t l = 0; l < net.levels(); ++l) {
        n.skip[l] = n.up[l];
        (l + 1 < net.levels() ? n.up[l + 1] : n.skip[l + 1]) =
            readByTranspose(n.up[l], net.decoder(l));
    }
    for (std::uint32_t l = net.levels(); l > 0; --l)
        n.skip[l - 1].merge(readByConv(n.skip[l], net.encoder(l)));
    n.input = net.head > 0 ? readByPoints(n.skip[0], net.encoder(0)) : n.skip[0];
    return n;
}

// Every tile with a needed pixel is wanted; and wanted tiles reach no farther than two tiles
// beyond what is needed: a bound for odd starts serves even ones, at four levels 15 pixels.
void checkReach(const TileReach& reach, const Pixels& needed, int p)
{
    const int side = int(gpu::kTileSide), scale = 1 << reach.level;
    const int low = (p - 512) / scale / side, high = (p + 512) / scale / side;
    for (int tile = low; tile < high; ++tile) {
        const int first = tile * side, end = first + side;
        const bool wanted =
            first * scale - int(reach.before) <= p && p < end * scale + int(reach.after);
        const auto from = needed.lower_bound(first), near = needed.lower_bound(first - 2 * side);
        if (from != needed.end() && *from < end)
            CHECK(wanted);
        if (near == needed.end() || *near >= end + 2 * side)
            CHECK_FALSE(wanted);
    }
}

} // namespace

TEST_CASE("U-Net tiles: every layer's tiles hold what an output pixel needs, and little more")
{
    for (const UNetDesc& net : {UNetDesc{}, UNetDesc{.out = 16}, hairUNet(), benchmarkUNet()}) {
        const UNetReach reach = unetReach(net);
        for (int p = 2048; p < 2048 + 64; ++p) { // far from the border: all phases of a tile
            CAPTURE(p);
            const Needs needs = followTaps(net, p);
            checkReach(reach.y, {p}, p);
            checkReach(reach.input, needs.input, p);
            for (std::uint32_t l = 0; l < net.levels(); ++l) {
                CAPTURE(l);
                checkReach(reach.up[l], needs.up[l], p);
                checkReach(reach.skip[l + 1], needs.skip[l + 1], p);
            }
        }
    }
}
