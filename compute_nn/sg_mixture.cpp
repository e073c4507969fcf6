#include "compute_nn/sg_mixture.hpp"

#include <algorithm>
#include <string>

#include "engine/base/error.hpp"
#include "kernels.gen.hpp"

namespace strandlight {

namespace {

// Directions of one invocation of sg_mixture.comp, and of eight neighbours.
constexpr std::uint32_t kDirectionTile = 4;
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
    checkTripBudget("sg_mixture", desc.lobes);
    PassBuilder pass = graph.addComputePass("sg mixture");
    const BufferId from = pass.read(lobes.buffer);
    const BufferId along = pass.read(directions);
    const BufferId to = pass.write(radiance.buffer);
    gpu::SgMixturePush push = pushOf(desc);
    const std::uint32_t slice = imagesPerDispatch(desc);
    const std::uint32_t tile = kDirectionTile * 8;
    const bool lanes = graph.context().subgroupSize() >= 8;
    for (; push.firstImage < desc.images; push.firstImage += slice)
        pass.dispatch(kernels::sg_mixture,
                      {(desc.directions + tile - 1) / tile * 8,
                       std::min(slice, desc.images - push.firstImage), 1},
                      push, {from, along, to}, {lanes ? 1u : 0u});
    return radiance.as(to);
}

TensorId sgMixtureBackward(RenderGraph& graph, const SgMixtureDesc& desc, const TensorId& raw,
                           BufferId directions, const TensorId& dRadiance, const TensorId& dRaw)
{
    checkTensor("raw", raw, desc.raw().elements());
    checkTensor("radiance gradient", dRadiance, desc.radianceElements());
    checkTensor("raw gradient", dRaw, desc.raw().elements());
    checkTripBudget("sg_mixture_backward", desc.directions);
    PassBuilder pass = graph.addComputePass("sg mixture backward");
    const BufferId values = pass.read(raw.buffer);
    const BufferId along = pass.read(directions);
    const BufferId from = pass.read(dRadiance.buffer);
    const BufferId to = pass.write(dRaw.buffer);
    gpu::SgMixturePush push = pushOf(desc);
    const std::uint32_t slice = imagesPerDispatch(desc);
    const bool lanes = graph.context().subgroupSize() >= 8;
    for (; push.firstImage < desc.images; push.firstImage += slice)
        pass.dispatch(kernels::sg_mixture_backward,
                      {std::min(slice, desc.images - push.firstImage) * desc.lobes, 1, 1}, push,
                      {values, along, from, to}, {lanes && desc.lobes % 8 == 0 ? 1u : 0u});
    return dRaw.as(to);
}

} // namespace strandlight
