#include "compute_nn/sg_mixture.hpp"

#include <algorithm>
#include <string>

#include "engine/base/error.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

// Lobes that one invocation keeps in registers, measured on lavapipe: more do not pay.
constexpr std::uint32_t kForwardLobes = 8;
constexpr std::uint32_t kBackwardLobes = 4;
// Lobe evaluations of one dispatch: about 30 ms on two lavapipe threads.
constexpr std::uint64_t kDispatchWork = 8'000'000;

gpu::SgMixturePush pushOf(const SgMixtureDesc& desc)
{
    return {desc.images,
            desc.lobes,
            desc.directions,
            desc.sharedDirections ? 0 : desc.directions * 3,
            desc.planar ? 1u : 3u,
            desc.planar ? desc.directions : 1u,
            0};
}

void checkTensor(const char* what, const TensorId& tensor, std::uint64_t elements)
{
    if (!tensor.whole() || tensor.desc.elements() != elements)
        throw Error(std::string("sg mixture: ") + what + " " + shapeText(tensor.desc) +
                    " has not " + std::to_string(elements) + " elements");
}

// Most of 1..limit that divides the lobes.
std::uint32_t lobeTile(std::uint32_t lobes, std::uint32_t limit)
{
    std::uint32_t tile = std::min(lobes, limit);
    while (lobes % tile != 0)
        --tile;
    return tile;
}

// Directions at once: four when they and their radiance are whole texels of four floats.
std::uint32_t directionTile(const SgMixtureDesc& desc)
{
    return desc.planar && desc.directions % 4 == 0 ? 4 : 1;
}

std::uint32_t imagesPerDispatch(const SgMixtureDesc& desc)
{
    const std::uint64_t perImage = std::uint64_t(desc.lobes) * desc.directions;
    // Images are a dimension of the dispatch, which a device may limit to 65,535 groups.
    return std::uint32_t(std::clamp<std::uint64_t>(kDispatchWork / perImage, 1, 32768));
}

} // namespace

TensorId addSgDecodePass(RenderGraph& graph, const SgMixtureDesc& desc, const TensorId& raw)
{
    checkTensor("raw", raw, desc.raw().elements());
    const TensorId lobes = createTensor(graph, "lobes", desc.raw());
    PassBuilder pass = graph.addComputePass("sg decode");
    const BufferId from = pass.read(raw.buffer);
    const BufferId to = pass.write(lobes.buffer);
    pass.dispatch(kernels::sg_decode, {desc.images * desc.lobes, 1, 1}, pushOf(desc), {from, to});
    return lobes.as(to);
}

TensorId sgMixtureForward(RenderGraph& graph, const SgMixtureDesc& desc, const TensorId& lobes,
                          BufferId directions, const TensorId& radiance)
{
    checkTensor("lobes", lobes, desc.raw().elements());
    checkTensor("radiance", radiance, desc.radianceElements());
    const std::uint32_t lobesAtOnce = lobeTile(desc.lobes, kForwardLobes);
    const std::uint32_t blocks = desc.lobes / lobesAtOnce;
    checkTripBudget("sg_mixture", gpu::kSgMixtureSlice * (blocks + 1));
    PassBuilder pass = graph.addComputePass("sg mixture");
    const BufferId from = pass.read(lobes.buffer);
    const BufferId along = pass.read(directions);
    const BufferId to = pass.write(radiance.buffer);
    gpu::SgMixturePush push = pushOf(desc);
    const std::uint32_t images = imagesPerDispatch(desc);
    const std::uint32_t slices =
        (desc.directions + gpu::kSgMixtureSlice - 1) / gpu::kSgMixtureSlice;
    for (; push.firstImage < desc.images; push.firstImage += images)
        pass.dispatch(kernels::sg_mixture,
                      {std::min(images, desc.images - push.firstImage), slices, 1}, push,
                      {from, along, along, to, to}, {lobesAtOnce, blocks, directionTile(desc)});
    return radiance.as(to);
}

TensorId sgMixtureBackward(RenderGraph& graph, const SgMixtureDesc& desc, const TensorId& raw,
                           BufferId directions, const TensorId& dRadiance, const TensorId& dRaw)
{
    checkTensor("raw", raw, desc.raw().elements());
    checkTensor("radiance gradient", dRadiance, desc.radianceElements());
    checkTensor("raw gradient", dRaw, desc.raw().elements());
    const std::uint32_t lobesAtOnce = lobeTile(desc.lobes, kBackwardLobes);
    const std::uint32_t tile = directionTile(desc);
    checkTripBudget("sg_mixture_backward", desc.directions / tile);
    PassBuilder pass = graph.addComputePass("sg mixture backward");
    const BufferId values = pass.read(raw.buffer);
    const BufferId along = pass.read(directions);
    const BufferId from = pass.read(dRadiance.buffer);
    const BufferId to = pass.write(dRaw.buffer);
    gpu::SgMixturePush push = pushOf(desc);
    const std::uint32_t images = imagesPerDispatch(desc);
    for (; push.firstImage < desc.images; push.firstImage += images)
        pass.dispatch(
            kernels::sg_mixture_backward,
            {std::min(images, desc.images - push.firstImage), desc.lobes / lobesAtOnce, 1}, push,
            {values, along, along, from, from, to}, {lobesAtOnce, tile});
    return dRaw.as(to);
}

} // namespace strandlight
