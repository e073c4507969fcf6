#include "compute_nn/network_shapes.hpp"

#include <string>

#include "engine/base/error.hpp"

namespace strandlight {

namespace {

void addConv(ParameterLayout& layout, const std::string& name, const Conv2dDesc& d)
{
    layout.addLayer(name, {d.out, d.in, d.kernel.h, d.kernel.w}, d.out,
                    d.in * d.kernel.h * d.kernel.w);
}

// Each output pixel of a stride-s transposed convolution sums kernel / stride^2 taps of every input
// channel.
void addConvTranspose(ParameterLayout& layout, const std::string& name,
                      const ConvTranspose2dDesc& d)
{
    layout.addLayer(name, {d.in, d.out, d.kernel.h, d.kernel.w}, d.out,
                    d.in * d.kernel.h * d.kernel.w / (d.stride.h * d.stride.w));
}

} // namespace

ParameterLayout EncoderDesc::parameters() const
{
    ParameterLayout layout;
    for (std::uint32_t i = 0; i < 4; ++i)
        addConv(layout, "conv" + std::to_string(i), layer(i));
    addConv(layout, "head", head());
    return layout;
}

ParameterLayout UNetDesc::parameters() const
{
    ParameterLayout layout;
    for (std::uint32_t l = head > 0 ? 0 : 1; l <= levels(); ++l)
        addConv(layout, "enc" + std::to_string(l), encoder(l));
    for (std::uint32_t l = levels(); l-- > 0;)
        addConvTranspose(layout, "dec" + std::to_string(l), decoder(l));
    addConv(layout, "out", last());
    return layout;
}

void UNetDesc::check(const TensorDesc& x) const
{
    if (down.empty() || down.size() != up.size() || down.size() > 8 ||
        (upKernel != 2 && upKernel != 4))
        throw Error("U-Net: " + std::to_string(down.size()) + " levels down, " +
                    std::to_string(up.size()) + " up, upward kernels of " +
                    std::to_string(upKernel) + " are no network");
    const std::uint32_t multiple = 1u << levels();
    if (x.c != in || x.n == 0 || x.h == 0 || x.w == 0 || x.h % multiple != 0 || x.w % multiple != 0)
        throw Error("U-Net: the input " + shapeText(x) + " is not [N," + std::to_string(in) +
                    ",H,W] with H and W multiples of " + std::to_string(multiple));
}

UNetDesc hairUNet(HairUNetSize size)
{
    switch (size) {
    case HairUNetSize::Small:
        return {.in = 26, .out = 12, .head = 0, .down = {16, 24, 32}, .up = {24, 16, 16}};
    case HairUNetSize::Medium:
        return {.in = 26, .out = 12, .head = 0, .down = {32, 48, 64}, .up = {48, 32, 16}};
    case HairUNetSize::Large:
        break;
    }
    return {.in = 26, .out = 12, .head = 16, .down = {40, 56, 80}, .up = {56, 40, 24}};
}

UNetDesc benchmarkUNet()
{
    return {.head = 16, .down = {16, 32, 64, 64}, .up = {64, 32, 16, 16}, .upKernel = 4};
}

} // namespace strandlight
