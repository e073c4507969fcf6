#include "compute_nn/activation.hpp"

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

TensorId addForwardPass(RenderGraph& graph, std::string_view name, std::uint32_t kind, float slope,
                        const TensorId& x, const TensorId& y)
{
    PassBuilder pass = graph.addComputePass(name);
    const BufferId from = pass.read(x.buffer);
    const BufferId to = pass.write(y.buffer);
    const gpu::ElementPush push = elementPush(x, y, x, slope);
    pass.dispatch(kernels::activation, elementThreads(push, y.desc.n), push, {from, from, to},
                  {kind, 0});
    return y.as(to);
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
    PassBuilder pass = graph.addComputePass(name);
    const BufferId from = pass.read(dY.buffer);
    const BufferId saved = pass.read(y.buffer);
    const BufferId to = pass.write(dX.buffer);
    const gpu::ElementPush push = elementPush(dY, dX, y, activation.slope);
    pass.dispatch(kernels::activation, elementThreads(push, y.desc.n), push, {from, saved, to},
                  {std::uint32_t(activation.kind), 1});
    return dX.as(to);
}

TensorId log1pForward(RenderGraph& graph, std::string_view name, const TensorId& x,
                      const TensorId& y)
{
    return addForwardPass(graph, name, kLog1p, 0.0f, x, y);
}

} // namespace strandlight
