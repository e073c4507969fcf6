#include "compute_nn/conv_weight_forms.hpp"

#include <algorithm>

#include "compute_nn/conv_work.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

std::uint32_t pixelsOf(const TensorId& tensor)
{
    return tensor.desc.n * tensor.desc.pixels();
}

// Any shape: conv_backward_weight.comp.
WeightForm generalForm(std::uint32_t shuffleFlag, const Correlation& c)
{
    const std::uint32_t columns = c.large.desc.c * c.kernel.h * c.kernel.w;
    const std::uint32_t pixels = pixelsOf(c.small);
    const std::uint32_t channelVectors = c.small.desc.c > kConvLanes ? 2 : 1;
    const std::uint32_t columnTile = columns > 8 ? 32 : 8;

    WeightForm form;
    form.blob = &kernels::conv_backward_weight;
    form.constants = {channelVectors, columnTile, 2, shuffleFlag};
    form.tilesA = divideUp(c.small.desc.c, kConvLanes * channelVectors);
    form.tilesB = divideUp(columns, columnTile);
    // Enough strips to fill the threads, short enough for the trip budget, few enough to keep the
    // strips small.
    const std::uint32_t wanted =
        std::max(divideUp(256, form.tilesA * form.tilesB), divideUp(pixels, 16384));
    form.stripLength = std::max(divideUp(pixels, wanted), 16u); // pixels
    form.strips = divideUp(pixels, form.stripLength);
    form.stripWork = std::uint64_t(form.stripLength) * form.tilesA * form.tilesB * columnTile *
                     kConvLanes * channelVectors;
    return form;
}

bool hasQuadForm(const Correlation& c)
{
    return wholeQuads(c.small) && wholeQuads(c.large) && c.kernel.h * c.kernel.w <= 64;
}

WeightForm quadForm(std::uint32_t shuffleFlag, const Correlation& c)
{
    const std::uint32_t taps = c.kernel.h * c.kernel.w;
    // Sums of an invocation, measured on lavapipe: more spill, fewer load more.
    const std::uint32_t sums = c.stride.w == 1 ? 108 : 72;
    const std::uint32_t channelVectors = c.small.desc.c > kConvLanes && taps * 2 <= sums ? 2 : 1;
    const std::uint32_t largeTile = std::clamp(sums / (taps * channelVectors), 1u, 16u);
    const std::uint32_t tilesB = divideUp(c.large.desc.c, largeTile);
    const std::uint32_t channels = divideUp(c.large.desc.c, tilesB);
    const std::uint32_t columns = c.small.desc.w > 4 ? 8 : 4;
    const std::uint32_t rows = c.small.desc.n * c.small.desc.h;
    const std::uint32_t turnsPerRow = divideUp(c.small.desc.w, columns);

    WeightForm form;
    form.blob = &kernels::conv_weight_quads;
    form.constants = {channelVectors, channels,   columns,     c.kernel.h,  c.kernel.w,
                      c.stride.h,     c.stride.w, c.padding.h, c.padding.w, shuffleFlag};
    form.tilesA = divideUp(c.small.desc.c, kConvLanes * channelVectors);
    form.tilesB = tilesB;
    // About 400 turns: what the tiles of a strip share fits a core's own cache.
    form.stripLength = std::clamp(400 / turnsPerRow, 1u, rows); // rows
    form.strips = divideUp(rows, form.stripLength);
    form.stripWork = std::uint64_t(form.stripLength) * turnsPerRow * columns * form.tilesA *
                     kConvLanes * channelVectors * tilesB * channels * taps;
    form.unitTurns = turnsPerRow;
    return form;
}

bool hasPointForm(const Correlation& c)
{
    return wholeQuads(c.small) && wholeQuads(c.large) && c.kernel == Extent2{3, 3} &&
           c.stride == Extent2{1, 1} && c.padding.h <= 2 && c.padding.w <= 2 &&
           std::max(c.small.desc.c, c.large.desc.c) >= 8;
}

WeightForm pointForm(std::uint32_t shuffleFlag, const Correlation& c)
{
    WeightForm form;
    // Lanes are channels of the small tensor; where it would leave them empty the two change
    // places, with the kernel turned about.
    form.turned = c.small.desc.c < 8 && c.large.desc.c > c.small.desc.c;
    const TensorDesc& small = form.turned ? c.large.desc : c.small.desc;
    const TensorDesc& large = form.turned ? c.small.desc : c.large.desc;
    const std::uint32_t channelVectors = small.c > kConvLanes ? 2 : 1;
    constexpr std::uint32_t kLarge = 4;                         // channels b of an invocation
    constexpr std::uint32_t kColumns = 8 * kConvLanes / kLarge; // of a turn
    const std::uint32_t pairs = small.n * divideUp(small.h, 2);
    const std::uint32_t turnsPerRow = divideUp(small.w, kColumns);

    const bool whole = small.w % kColumns == 0 && small.h % 2 == 0 && small.w == large.w;

    form.blob = &kernels::conv_weight_points;
    form.constants = {channelVectors, kLarge, form.turned ? 2 - c.padding.h : c.padding.h,
                      form.turned ? 2 - c.padding.w : c.padding.w,
                      shuffleFlag | (whole ? gpu::kConvWhole : 0)};
    form.tilesA = divideUp(small.c, kConvLanes * channelVectors);
    form.tilesB = divideUp(large.c, kLarge);
    // About 100 turns: what the tiles of a strip share fits a core's own cache.
    form.stripLength = std::clamp(100 / turnsPerRow, 1u, pairs); // pairs of rows
    form.strips = divideUp(pairs, form.stripLength);
    form.stripWork = std::uint64_t(form.stripLength) * turnsPerRow * kColumns * form.tilesA *
                     kConvLanes * channelVectors * form.tilesB * kLarge * 9;
    form.unitTurns = turnsPerRow;
    return form;
}

// Sums that a thread of conv_weight_tile.comp keeps: kWeightTileChannels times the kernel's width.
constexpr std::uint32_t kTileKernelWidth = 8;

WeightForm tileForm(const Correlation& c)
{
    const TensorDesc& small = c.small.desc;
    const std::uint32_t threadsA = small.c > 16 ? 4 : small.c > 8 ? 2 : 1;
    // With one thread across, 128 rows (b,ky) lie in shared memory: shorter, to fit 32 KiB.
    const std::uint32_t pixels = small.w > 16 && threadsA > 1 ? 32
                                 : small.w > 8                ? 16
                                 : small.w > 4                ? 8
                                                              : 4;
    const std::uint32_t rows = c.large.desc.c * c.kernel.h;
    const std::uint32_t threadsB = gpu::kWeightTileThreads / threadsA;
    const std::uint32_t steps = small.n * small.h * divideUp(small.w, pixels);
    const std::uint64_t elements = std::uint64_t(small.c) * rows * c.kernel.w;

    WeightForm form;
    form.blob = &kernels::conv_weight_tile;
    form.constants = {threadsA,   pixels,     c.kernel.h,  c.kernel.w,
                      c.stride.h, c.stride.w, c.padding.h, c.padding.w};
    form.groupSize = gpu::kWeightTileThreads;
    form.tilesA = divideUp(small.c, threadsA * gpu::kWeightTileChannels);
    form.tilesB = divideUp(rows, threadsB);
    // Some 2000 workgroups fill the largest GPU; but no more than 16 MiB of strips.
    const std::uint32_t wanted = std::uint32_t(std::clamp<std::uint64_t>(
        2048 / (form.tilesA * form.tilesB), 1, std::max<std::uint64_t>((1u << 22) / elements, 1)));
    form.stripLength = divideUp(steps, wanted); // steps of `pixels` pixels
    form.strips = divideUp(steps, form.stripLength);
    form.stripWork = std::uint64_t(form.stripLength) * pixels * form.tilesA * form.tilesB *
                     gpu::kWeightTileThreads * gpu::kWeightTileChannels * c.kernel.w;
    // Of a step: the loads of both tiles, then the sums by four pixels.
    const std::uint32_t turns =
        divideUp(threadsA * gpu::kWeightTileChannels * pixels, gpu::kWeightTileThreads) +
        divideUp(threadsB * ((pixels - 1) * c.stride.w + c.kernel.w), gpu::kWeightTileThreads) +
        pixels / 4;
    form.unitTurns = turns + 4;
    return form;
}

bool hasTileForm(const Correlation& c)
{
    // Both tiles fit 32 KiB of shared memory at strides up to 2.
    return c.kernel.w <= kTileKernelWidth && c.stride.w <= 2;
}

} // namespace

WeightForm weightForm(bool cpu, std::uint32_t shuffleFlag, const Correlation& c)
{
    if (cpu && hasPointForm(c))
        return pointForm(shuffleFlag, c);
    if (cpu)
        return hasQuadForm(c) ? quadForm(shuffleFlag, c) : generalForm(shuffleFlag, c);
    return hasTileForm(c) ? tileForm(c) : generalForm(shuffleFlag, c);
}

} // namespace strandlight
