#include "compute_nn/sg_mixture.hpp"

#include <algorithm>
#include <string>

#include "compute_nn/tensor_parts.hpp"
#include "engine/base/error.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

// What one invocation keeps in registers, at most.
struct MixtureTile
{
    std::uint32_t forwardLobes, forwardDirections, backwardLobes, backwardDirections;
};
// lavapipe (Mesa 22.3.6, 256 bits), by the CPU time of one thread: of 4 or 8 lobes and 4, 8 or 16
// directions, backward 8 x 8 takes a sixth less time than 4 x 4; forward 8 x 8, stored by eights,
// takes a ninth less than 8 x 4 by fours.
constexpr MixtureTile kCpuTile = {8, 8, 8, 8};
// Not measured: half the registers backward.
constexpr MixtureTile kGpuTile = {8, 4, 4, 4};

const MixtureTile& mixtureTile(const RenderGraph& graph)
{
    return graph.context().cpuForms() ? kCpuTile : kGpuTile;
}

// Lobe evaluations of one dispatch: about 20 ms on two lavapipe threads.
constexpr std::uint64_t kDispatchWork = 32'000'000;

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

// Directions at once: whole texels of four floats, they and their radiance, or one.
std::uint32_t directionTile(const SgMixtureDesc& desc, std::uint32_t limit)
{
    std::uint32_t tile = desc.planar ? limit : 1;
    while (tile > 1 && desc.directions % tile != 0)
        tile = tile > 4 ? tile / 2 : 1;
    return tile;
}

// Calls dispatch(push, part) for so many images at once as can be bound and make a dispatch;
// part(buffer, floats) binds those of a buffer that has `floats` for each.
template <class Dispatch>
void forParts(const RenderGraph& graph, const SgMixtureDesc& desc, Dispatch dispatch)
{
    const std::uint64_t perImage = std::uint64_t(desc.lobes) * desc.directions;
    // Images are a dimension of the dispatch, which a device may limit to 65,535 groups.
    const auto perDispatch =
        std::uint32_t(std::clamp<std::uint64_t>(kDispatchWork / perImage, 1, 32768));
    const std::uint32_t perPart =
        flatImagesPerPart(graph, "sg mixture", desc.images,
                          std::max<std::uint64_t>(desc.lobes * 7ull, desc.directions * 3ull));
    gpu::SgMixturePush push = pushOf(desc);
    for (std::uint32_t first = 0; first < desc.images; first += perPart) {
        push.images = std::min(perPart, desc.images - first);
        const auto part = [&](BufferId buffer, std::uint32_t floats) {
            return flatPart(buffer, desc.images, floats, first, push.images);
        };
        for (push.firstImage = 0; push.firstImage < push.images; push.firstImage += perDispatch)
            dispatch(push, std::min(perDispatch, push.images - push.firstImage), part);
    }
}

template <class Part>
Binding directionsOf(const SgMixtureDesc& desc, BufferId directions, const Part& part)
{
    return desc.sharedDirections ? Binding(directions) : part(directions, desc.directions * 3);
}

} // namespace

TensorId addSgDecodePass(RenderGraph& graph, const SgMixtureDesc& desc, const TensorId& raw)
{
    checkTensor("raw", raw, desc.raw().elements());
    const TensorId lobes = createTensor(graph, "lobes", desc.raw());
    PassBuilder pass = graph.addComputePass("sg decode");
    const BufferId from = pass.read(raw.buffer);
    const BufferId to = pass.write(lobes.buffer);
    const std::uint32_t floats = desc.lobes * 7;
    const std::uint32_t perPart = flatImagesPerPart(graph, "sg decode", desc.images, floats);
    gpu::SgMixturePush push = pushOf(desc);
    for (std::uint32_t first = 0; first < desc.images; first += perPart) {
        push.images = std::min(perPart, desc.images - first);
        pass.dispatch(kernels::sg_decode, {push.images * desc.lobes, 1, 1}, push,
                      {flatPart(from, desc.images, floats, first, push.images),
                       flatPart(to, desc.images, floats, first, push.images)});
    }
    return lobes.as(to);
}

TensorId sgMixtureForward(RenderGraph& graph, const SgMixtureDesc& desc, const TensorId& lobes,
                          BufferId directions, const TensorId& radiance)
{
    checkTensor("lobes", lobes, desc.raw().elements());
    checkTensor("radiance", radiance, desc.radianceElements());
    const std::uint32_t lobesAtOnce = lobeTile(desc.lobes, mixtureTile(graph).forwardLobes);
    const std::uint32_t blocks = desc.lobes / lobesAtOnce;
    checkTripBudget("sg_mixture", gpu::kSgMixtureSlice * (blocks + 1));
    PassBuilder pass = graph.addComputePass("sg mixture");
    const BufferId from = pass.read(lobes.buffer);
    const BufferId along = pass.read(directions);
    const BufferId to = pass.write(radiance.buffer);
    const std::uint32_t slices =
        (desc.directions + gpu::kSgMixtureSlice - 1) / gpu::kSgMixtureSlice;
    const std::uint32_t tile = directionTile(desc, mixtureTile(graph).forwardDirections);
    const KernelBlob& kernel = tile == 8 ? kernels::sg_mixture_wide : kernels::sg_mixture;
    forParts(graph, desc, [&](const auto& push, std::uint32_t images, const auto& part) {
        const Binding list = directionsOf(desc, along, part);
        const Binding result = part(to, desc.directions * 3);
        const Binding values = part(from, desc.lobes * 7);
        pass.dispatch(kernel, {images, slices, 1}, push,
                      {values, list, list, result, result, values}, {lobesAtOnce, blocks, tile});
    });
    return radiance.as(to);
}

TensorId sgMixtureBackward(RenderGraph& graph, const SgMixtureDesc& desc, const TensorId& raw,
                           BufferId directions, const TensorId& dRadiance, const TensorId& dRaw)
{
    checkTensor("raw", raw, desc.raw().elements());
    checkTensor("radiance gradient", dRadiance, desc.radianceElements());
    checkTensor("raw gradient", dRaw, desc.raw().elements());
    const std::uint32_t lobesAtOnce = lobeTile(desc.lobes, mixtureTile(graph).backwardLobes);
    const std::uint32_t tile = directionTile(desc, mixtureTile(graph).backwardDirections);
    checkTripBudget("sg_mixture_backward", desc.directions / tile);
    PassBuilder pass = graph.addComputePass("sg mixture backward");
    const BufferId values = pass.read(raw.buffer);
    const BufferId along = pass.read(directions);
    const BufferId from = pass.read(dRadiance.buffer);
    const BufferId to = pass.write(dRaw.buffer);
    const KernelBlob& kernel = graph.context().cpuForms() && lobesAtOnce % 8 == 0
                                   ? kernels::sg_mixture_backward_wide
                                   : kernels::sg_mixture_backward;
    forParts(graph, desc, [&](const auto& push, std::uint32_t images, const auto& part) {
        const Binding list = directionsOf(desc, along, part);
        const Binding gradient = part(from, desc.directions * 3);
        const Binding lobes = part(values, desc.lobes * 7);
        pass.dispatch(kernel, {images, desc.lobes / lobesAtOnce, 1}, push,
                      {lobes, list, list, gradient, gradient, part(to, desc.lobes * 7), lobes},
                      {lobesAtOnce, tile});
    });
    return dRaw.as(to);
}

} // namespace strandlight
