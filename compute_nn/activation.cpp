#include "compute_nn/activation.hpp"
#include "compute_nn/tensor_parts.hpp"

#include <algorithm>
#include <string>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

namespace {

constexpr std::uint32_t kLog1p = 5; // of activation.comp

gpu::ElementPush elementPush(const TensorId& in, const TensorId& out, const TensorId& saved,
                             float slope)
{
    STRANDLIGHT_ASSERT(in.desc == out.desc && saved.desc == out.desc);
    return {in.view(), out.view(), saved.view(), out.desc.c * out.desc.pixels(), slope};
}

// Rows of 2^20 threads: an axis takes 65,535 groups.
glm::uvec3 elementThreads(const gpu::ElementPush& push, std::uint32_t images)
{
    constexpr std::uint32_t kRow = 1u << 20;
    return {std::min(push.channelPixels, kRow), images, (push.channelPixels + kRow - 1) / kRow};
}

// Calls add(part) -> version for images and channels that all of the tensors can bind.
template <class Add>
TensorId addByParts(RenderGraph& graph, std::string_view name, const TensorId& in,
                    const TensorId& saved, TensorId out, Add add)
{
    if (fitBindings(graph, {in, saved, out}))
        return out.as(add(in, saved, out));
    const std::uint32_t images = imagesPerPart(graph, {in, saved, out});
    for (std::uint32_t n = 0; n < out.desc.n; n += images) {
        const std::uint32_t count = std::min(images, out.desc.n - n);
        const std::uint32_t channels = count == 1 ? channelsPerPart(graph, name, out) : out.desc.c;
        for (std::uint32_t c = 0; c < out.desc.c; c += channels) {
            const auto part = [&](const TensorId& t) {
                return boundPart(t, n, count, c, std::min(channels, out.desc.c - c));
            };
            out = out.as(add(part(in), part(saved), part(out)));
        }
    }
    return out;
}

TensorId addForwardPass(RenderGraph& graph, std::string_view name, std::uint32_t kind, float slope,
                        const TensorId& x, const TensorId& y)
{
    STRANDLIGHT_ASSERT(x.element == Element::Float);
    const KernelBlob& kernel =
        y.element == Element::Float ? kernels::activation : kernels::activation_to_half;
    return addByParts(graph, name, x, x, y,
                      [&](const TensorId& in, const TensorId&, const TensorId& out) {
                          PassBuilder pass = graph.addComputePass(name);
                          const Binding from = in.binding(pass.read(in.buffer));
                          const BufferId to = pass.write(out.buffer);
                          const gpu::ElementPush push = elementPush(in, out, in, slope);
                          pass.dispatch(kernel, elementThreads(push, out.desc.n), push,
                                        {from, from, out.binding(to)}, {kind, 0});
                          return to;
                      });
}

} // namespace

float fusedSlope(const Activation& activation)
{
    switch (activation.kind) {
    case ActivationKind::None:
        return 1.0f;
    case ActivationKind::Relu:
        return 0.0f;
    case ActivationKind::LeakyRelu:
        return activation.slope;
    case ActivationKind::Softplus:
    case ActivationKind::Sigmoid:
        break;
    }
    throw Error("softplus and sigmoid are passes of their own; a convolution does not fuse them");
}

TensorId activationForward(RenderGraph& graph, std::string_view name, const Activation& activation,
                           const TensorId& x, const TensorId& y)
{
    return addForwardPass(graph, name, std::uint32_t(activation.kind), activation.slope, x, y);
}

TensorId activationBackward(RenderGraph& graph, std::string_view name, const Activation& activation,
                            const TensorId& y, const TensorId& dY, const TensorId& dX)
{
    return addByParts(
        graph, name, dY, y, dX,
        [&](const TensorId& in, const TensorId& saved, const TensorId& out) {
            PassBuilder pass = graph.addComputePass(name);
            const Binding from = in.binding(pass.read(in.buffer));
            const Binding value = saved.binding(pass.read(saved.buffer));
            const BufferId to = pass.write(out.buffer);
            const gpu::ElementPush push = elementPush(in, out, saved, activation.slope);
            pass.dispatch(kernels::activation, elementThreads(push, out.desc.n), push,
                          {from, value, out.binding(to)}, {std::uint32_t(activation.kind), 1});
            return to;
        });
}

TensorId storeAsHalves(RenderGraph& graph, std::string_view name, const TensorId& x,
                       const TensorId& y)
{
    STRANDLIGHT_ASSERT(y.element == Element::Half);
    return activationForward(graph, name, Activation::none(), x, y);
}

TensorId log1pForward(RenderGraph& graph, std::string_view name, const TensorId& x,
                      const TensorId& y)
{
    return addForwardPass(graph, name, kLog1p, 0.0f, x, y);
}

} // namespace strandlight
