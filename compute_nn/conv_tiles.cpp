#include "compute_nn/conv_tiles.hpp"

#include <span>

#include "shaders/shared/nn_types.h"

namespace strandlight {

namespace {

struct Case
{
    RowShape shape;
    std::uint32_t minimumWidth; // of the grid, for batches
    RowTile tile;
};

constexpr bool kConv = false, kTransposed = true;

// lavapipe (Mesa 22.3.6, 256 bits), the fastest of some three to six tiles each by the CPU time of
// one thread, on the shapes that `bench kernels --filter conv` times. More sums spill, more input
// channels a turn pay only where a turn is short, as with 2x2. Transposed 3x3 of stride 1 was not
// compared.
constexpr Case kCpu[] = {
    {{kConv, {3, 3}, {1, 1}}, 8, {16, 8, 1}},
    {{kConv, {3, 3}, {2, 2}}, 8, {16, 8, 1}},
    {{kConv, {4, 4}, {2, 2}}, 8, {16, 4, 1}},
    {{kConv, {2, 2}, {2, 2}}, 8, {16, 4, 1}},
    {{kConv, {1, 1}, {1, 1}}, 8, {16, 8, 1}},
    {{kTransposed, {3, 3}, {1, 1}}, 8, {16, 8, 1}},
    {{kTransposed, {3, 3}, {2, 2}}, 8, {8, 4, 2}},
    {{kTransposed, {4, 4}, {2, 2}}, 8, {32, 4, 1, true}},
    {{kTransposed, {2, 2}, {2, 2}}, 8, {16, 4, 2, true}},
};

struct ChannelCase
{
    RowShape shape;
    RowTile tile;
};

// lavapipe again: 1.2 times as fast as the rows above with three taps, 1.1 times with four. With
// stride 2 and three taps it was no faster.
constexpr ChannelCase kCpuChannels[] = {
    {{kConv, {3, 3}, {1, 1}},
     {.channels = 0, .columns = 8, .turn = 1, .minimal = true, .rows = 6, .lanes = 8}},
    {{kConv, {4, 4}, {2, 2}}, {.channels = 0, .columns = 8, .turn = 1, .rows = 3, .lanes = 8}},
    {{kTransposed, {4, 4}, {2, 2}},
     {.channels = 0, .columns = 4, .turn = 1, .rows = 6, .lanes = 8}},
};

// Not measured: half the tile, so that the sums fit 255 registers with room to hide latency.
constexpr Case kGpu[] = {
    {{kConv, {3, 3}, {1, 1}}, 32, {8, 4, 1}},       {{kConv, {3, 3}, {2, 2}}, 32, {8, 4, 1}},
    {{kConv, {4, 4}, {2, 2}}, 32, {8, 4, 1}},       {{kConv, {2, 2}, {2, 2}}, 32, {8, 4, 2}},
    {{kConv, {1, 1}, {1, 1}}, 32, {8, 4, 4}},       {{kTransposed, {3, 3}, {1, 1}}, 32, {8, 4, 1}},
    {{kTransposed, {3, 3}, {2, 2}}, 32, {4, 2, 1}}, {{kTransposed, {4, 4}, {2, 2}}, 32, {4, 2, 1}},
    {{kTransposed, {2, 2}, {2, 2}}, 32, {4, 2, 4}},
};

constexpr bool dividesTiles(std::span<const Case> cases)
{
    for (const Case& c : cases) {
        const Extent2 scale = c.shape.transposed ? c.shape.stride : Extent2{1, 1};
        if (gpu::kTileSide % scale.h != 0 || gpu::kTileSide % (scale.w * c.tile.columns) != 0)
            return false;
    }
    return true;
}
static_assert(dividesTiles(kCpu) && dividesTiles(kGpu));

// Over a list of tiles a workgroup of conv_lanes.glsl takes a whole one.
constexpr bool spansTiles(std::span<const ChannelCase> cases)
{
    for (const ChannelCase& c : cases)
        if (c.tile.columns * (c.shape.transposed ? c.shape.stride.w : 1) != gpu::kTileSide)
            return false;
    return true;
}
static_assert(spansTiles(kCpuChannels));

} // namespace

const RowTile* findRowTile(bool cpu, const RowShape& shape, std::uint32_t gridWidth,
                           std::uint32_t images)
{
    for (const Case& c : cpu ? std::span<const Case>(kCpu) : kGpu)
        if (c.shape == shape)
            return images == 1 || gridWidth >= c.minimumWidth ? &c.tile : nullptr;
    return nullptr;
}

const RowTile* findChannelTile(bool cpu, const RowShape& shape)
{
    if (cpu)
        for (const ChannelCase& c : kCpuChannels)
            if (c.shape == shape)
                return &c.tile;
    return nullptr;
}

} // namespace strandlight
