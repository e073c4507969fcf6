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
    addConv(layout, "enc0", enc0());
    addConv(layout, "enc1", enc1());
    addConv(layout, "enc2", enc2());
    addConvTranspose(layout, "dec1", dec1());
    addConvTranspose(layout, "dec0", dec0());
    addConv(layout, "out", last());
    return layout;
}

void UNetDesc::check(const TensorDesc& x) const
{
    if (x.c != in || x.n == 0 || x.h == 0 || x.w == 0 || x.h % 4 != 0 || x.w % 4 != 0)
        throw Error("U-Net: the input " + shapeText(x) + " is not [N," + std::to_string(in) +
                    ",H,W] with H and W multiples of 4");
}

} // namespace strandlight
