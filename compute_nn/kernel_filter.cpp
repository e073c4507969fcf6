#include "compute_nn/kernel_filter.hpp"

#include <string>

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

} // namespace

TensorId kernelFilterForward(RenderGraph& graph, std::string_view name, const TensorId& logits,
                             const TensorId& image, const TensorId& y)
{
    checkShape(name, "the image", image, gpu::kFilterChannels, image.desc);
    checkShape(name, "logits", logits, gpu::kFilterTaps, image.desc);
    checkShape(name, "the output", y, gpu::kFilterChannels, image.desc);
    PassBuilder pass = graph.addComputePass(name);
    const BufferId kernel = pass.read(logits.buffer);
    const BufferId from = pass.read(image.buffer);
    const BufferId to = pass.write(y.buffer);
    const gpu::KernelFilterPush push{logits.view(), image.view(), image.view(), y.view()};
    pass.dispatch(kernels::kernel_filter, {image.desc.pixels(), image.desc.n, 1}, push,
                  {kernel, from, from, to}, {0});
    return y.as(to);
}

TensorId kernelFilterBackward(RenderGraph& graph, std::string_view name, const TensorId& logits,
                              const TensorId& image, const TensorId& dY, const TensorId& dLogits)
{
    checkShape(name, "the image", image, gpu::kFilterChannels, image.desc);
    checkShape(name, "logits", logits, gpu::kFilterTaps, image.desc);
    checkShape(name, "the gradient", dY, gpu::kFilterChannels, image.desc);
    checkShape(name, "the logits' gradient", dLogits, gpu::kFilterTaps, image.desc);
    PassBuilder pass = graph.addComputePass(name);
    const BufferId kernel = pass.read(logits.buffer);
    const BufferId from = pass.read(image.buffer);
    const BufferId gradient = pass.read(dY.buffer);
    const BufferId to = pass.write(dLogits.buffer);
    const gpu::KernelFilterPush push{logits.view(), image.view(), dY.view(), dLogits.view()};
    pass.dispatch(kernels::kernel_filter, {image.desc.pixels(), image.desc.n, 1}, push,
                  {kernel, from, gradient, to}, {1});
    return dLogits.as(to);
}

} // namespace strandlight
