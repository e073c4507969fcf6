#include "compute_nn/kernel_filter.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "compute_nn/tensor_parts.hpp"
#include "engine/base/error.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

void checkShape(std::string_view name, const char* what, const TensorId& tensor, std::uint32_t c,
                const TensorDesc& image)
{
    const TensorDesc wanted{image.n, c, image.h, image.w};
    if (tensor.desc != wanted)
        throw Error(std::string(name) + ": " + what + " " + shapeText(tensor.desc) + " is not " +
                    shapeText(wanted));
}

// The planes of images [first, first + count) as three bindings of three planes each.
struct FilterGroups
{
    std::array<TensorId, 3> parts;

    FilterGroups(const TensorId& nine, std::uint32_t first, std::uint32_t count)
    {
        for (std::uint32_t g = 0; g < 3; ++g)
            parts[g] = boundPart(nine, first, count, g * gpu::kFilterGroup, gpu::kFilterGroup);
    }
    Binding binding(std::uint32_t group, BufferId version) const
    {
        return parts[group].binding(version);
    }
    std::uint32_t offset(std::uint32_t group) const { return parts[group].view().offset; }
};

// Images whose tensors can be bound, at least one; of one alone, three of its nine planes or all
// four of its colours.
std::uint32_t filterImages(const RenderGraph& graph, std::string_view name, const TensorId& nine,
                           std::initializer_list<TensorId> fours)
{
    std::uint32_t images = imagesPerPart(graph, {nine});
    for (const TensorId& four : fours)
        images = std::min(images, imagesPerPart(graph, {four}));
    bool fits = channelsPerPart(graph, name, nine) >= gpu::kFilterGroup;
    for (const TensorId& four : fours)
        fits = fits && channelsPerPart(graph, name, four) == gpu::kFilterChannels;
    if (!fits)
        throw Error(std::string(name) + ": four planes of " + shapeText(nine.desc) +
                    " are larger than the device can bind");
    return images;
}

} // namespace

TensorId kernelFilterForward(RenderGraph& graph, std::string_view name, const TensorId& logits,
                             const TensorId& image, const TensorId& y)
{
    checkShape(name, "the image", image, gpu::kFilterChannels, image.desc);
    checkShape(name, "logits", logits, gpu::kFilterTaps, image.desc);
    checkShape(name, "the output", y, gpu::kFilterChannels, image.desc);
    const std::uint32_t images = filterImages(graph, name, logits, {image, y});
    PassBuilder pass = graph.addComputePass(name);
    const BufferId kernel = pass.read(logits.buffer);
    const BufferId from = pass.read(image.buffer);
    const BufferId to = pass.write(y.buffer);
    for (std::uint32_t n = 0; n < image.desc.n; n += images) {
        const std::uint32_t count = std::min(images, image.desc.n - n);
        const FilterGroups k(logits, n, count);
        const TensorId x = boundPart(image, n, count, 0, gpu::kFilterChannels);
        const TensorId result = boundPart(y, n, count, 0, gpu::kFilterChannels);
        const gpu::KernelFilterPush push{.image = x.view(),
                                         .logitOffset = {k.offset(0), k.offset(1), k.offset(2)},
                                         .logitImageStride = logits.view().imageStride,
                                         .dYOffset = 0,
                                         .dYImageStride = 0,
                                         .resultOffset = {result.view().offset, 0, 0},
                                         .resultImageStride = result.view().imageStride};
        const Binding colors = x.binding(from), answer = result.binding(to);
        pass.dispatch(kernels::kernel_filter, {image.desc.pixels(), count, 1}, push,
                      {k.binding(0, kernel), k.binding(1, kernel), k.binding(2, kernel), colors,
                       colors, answer, answer, answer},
                      {0});
    }
    return y.as(to);
}

TensorId kernelFilterBackward(RenderGraph& graph, std::string_view name, const TensorId& logits,
                              const TensorId& image, const TensorId& dY, const TensorId& dLogits)
{
    checkShape(name, "the image", image, gpu::kFilterChannels, image.desc);
    checkShape(name, "logits", logits, gpu::kFilterTaps, image.desc);
    checkShape(name, "the gradient", dY, gpu::kFilterChannels, image.desc);
    checkShape(name, "the logits' gradient", dLogits, gpu::kFilterTaps, image.desc);
    const std::uint32_t images = std::min(filterImages(graph, name, logits, {image, dY}),
                                          filterImages(graph, name, dLogits, {}));
    PassBuilder pass = graph.addComputePass(name);
    const BufferId kernel = pass.read(logits.buffer);
    const BufferId from = pass.read(image.buffer);
    const BufferId gradient = pass.read(dY.buffer);
    const BufferId to = pass.write(dLogits.buffer);
    for (std::uint32_t n = 0; n < image.desc.n; n += images) {
        const std::uint32_t count = std::min(images, image.desc.n - n);
        const FilterGroups k(logits, n, count), result(dLogits, n, count);
        const TensorId x = boundPart(image, n, count, 0, gpu::kFilterChannels);
        const TensorId dOut = boundPart(dY, n, count, 0, gpu::kFilterChannels);
        const gpu::KernelFilterPush push{
            .image = x.view(),
            .logitOffset = {k.offset(0), k.offset(1), k.offset(2)},
            .logitImageStride = logits.view().imageStride,
            .dYOffset = dOut.view().offset,
            .dYImageStride = dOut.view().imageStride,
            .resultOffset = {result.offset(0), result.offset(1), result.offset(2)},
            .resultImageStride = dLogits.view().imageStride};
        pass.dispatch(kernels::kernel_filter, {image.desc.pixels(), count, 1}, push,
                      {k.binding(0, kernel), k.binding(1, kernel), k.binding(2, kernel),
                       x.binding(from), dOut.binding(gradient), result.binding(0, to),
                       result.binding(1, to), result.binding(2, to)},
                      {1});
    }
    return dLogits.as(to);
}

} // namespace strandlight
