#include "compute_nn/tensor_parts.hpp"

#include <algorithm>
#include <string>

#include "engine/base/error.hpp"

namespace strandlight {

namespace {

// As if all tensors were of floats. A part may begin anywhere, its binding only at multiples of the
// alignment.
std::uint64_t roomOf(const RenderGraph& graph)
{
    return graph.context().maxTensorBindingBytes() - Binding::kAlignment;
}

} // namespace

bool fitBindings(const RenderGraph& graph, std::initializer_list<TensorId> tensors)
{
    return std::all_of(tensors.begin(), tensors.end(), [&](const TensorId& t) {
        return t.boundBytes != 0 ||
               graph.desc(t.buffer).bytes / elementBytes(t.element) * sizeof(float) <=
                   graph.context().maxTensorBindingBytes();
    });
}

TensorId boundPart(const TensorId& tensor, std::uint32_t firstImage, std::uint32_t images,
                   std::uint32_t firstChannel, std::uint32_t channels)
{
    TensorId part = channelRange(tensor, firstChannel, channels);
    part.firstImage += firstImage;
    part.desc.n = images;
    const std::uint64_t planes = std::uint64_t(images - 1) * part.bufferChannels + channels;
    const std::uint32_t bytes = elementBytes(part.element);
    const std::uint64_t from = part.firstElement() * bytes;
    part.boundFrom = from / Binding::kAlignment * Binding::kAlignment;
    part.boundBytes = from + planes * part.desc.pixels() * bytes - part.boundFrom;
    return part;
}

std::uint32_t imagesPerPart(const RenderGraph& graph, std::initializer_list<TensorId> tensors)
{
    std::uint64_t images = ~0u;
    for (const TensorId& t : tensors)
        images = std::min<std::uint64_t>(images, roomOf(graph) / (t.view().imageStride * 4ull));
    return std::uint32_t(std::max<std::uint64_t>(images, 1));
}

std::uint32_t flatImagesPerPart(const RenderGraph& graph, std::string_view pass,
                                std::uint32_t images, std::uint64_t floats)
{
    constexpr std::uint64_t kStep = Binding::kAlignment / sizeof(float);
    const std::uint64_t most = graph.context().maxTensorBindingBytes() / (floats * sizeof(float));
    if (most >= images)
        return images;
    if (most < kStep)
        throw Error(std::string(pass) + ": " + std::to_string(kStep) + " parts of " +
                    std::to_string(floats * sizeof(float)) +
                    " bytes are more than the device can bind");
    return std::uint32_t(most / kStep * kStep);
}

Binding flatPart(BufferId buffer, std::uint32_t images, std::uint64_t floats, std::uint32_t first,
                 std::uint32_t count)
{
    const std::uint64_t image = floats * sizeof(float);
    return {buffer, first * image, first + count < images ? count * image : 0};
}

std::uint32_t channelsPerPart(const RenderGraph& graph, std::string_view pass,
                              const TensorId& tensor)
{
    const std::uint64_t planes = roomOf(graph) / (tensor.desc.pixels() * sizeof(float));
    if (planes == 0)
        throw Error(std::string(pass) + ": one plane of " + shapeText(tensor.desc) +
                    " is larger than the device can bind");
    return std::uint32_t(std::min<std::uint64_t>(planes, tensor.desc.c));
}

} // namespace strandlight
