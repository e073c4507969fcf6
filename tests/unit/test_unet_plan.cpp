// Shapes, sizes and parameter places of the networks, without a device.
#include <doctest/doctest.h>

#include <cmath>

#include "compute_nn/network_shapes.hpp"
#include "engine/base/error.hpp"

using namespace strandlight;

TEST_CASE("U-Net: every level has the size that its skip needs")
{
    const UNetDesc net;
    for (TensorDesc x :
         {TensorDesc{1, 24, 4, 4}, TensorDesc{2, 24, 24, 40}, TensorDesc{1, 24, 384, 640}}) {
        net.check(x);
        const TensorDesc e0 = net.enc0().output(x), e1 = net.enc1().output(e0),
                         e2 = net.enc2().output(e1), d1 = net.dec1().output(e2);
        CHECK_EQ(d1, e1);
        const TensorDesc d0 = net.dec0().output({e1.n, 2 * e1.c, e1.h, e1.w});
        CHECK_EQ(d0, e0);
        CHECK_EQ(net.last().output({e0.n, 2 * e0.c, e0.h, e0.w}), TensorDesc{x.n, 3, x.h, x.w});
    }
    CHECK_THROWS_AS(net.check({1, 24, 6, 8}), Error);
    CHECK_THROWS_AS(net.check({1, 23, 8, 8}), Error);
    CHECK_THROWS_AS(net.check({1, 24, 0, 8}), Error);
}

TEST_CASE("parameters lie next to each other, in order, without overlap")
{
    for (const ParameterLayout& layout : {UNetDesc{}.parameters(), EncoderDesc{}.parameters()}) {
        std::uint32_t end = 0;
        for (const ParameterSlice& slice : layout.slices()) {
            CHECK_EQ(slice.offset, end);
            end += slice.count;
        }
        CHECK_EQ(end, layout.count());
    }
    // 3-16-32-64-64 with 3x3 kernels and a dense layer 64 -> 56.
    CHECK_EQ(EncoderDesc{}.parameters().count(),
             27 * 16 + 16 + 144 * 32 + 32 + 288 * 64 + 64 + 576 * 64 + 64 + 64 * 56 + 56);
    CHECK_EQ(EncoderDesc{.imageSize = 32}.head().kernel, Extent2{2, 2});
    CHECK_THROWS_AS((void)UNetDesc{}.parameters().slice("enc3.weight"), Error);
}

TEST_CASE("initial weights: He's deviation, zero biases, a pure function of the seed")
{
    const ParameterLayout layout = EncoderDesc{}.parameters();
    const std::vector<float> values = layout.initialValues(1);
    CHECK_EQ(values, layout.initialValues(1));
    CHECK_NE(values, layout.initialValues(2));
    const ParameterSlice& slice = layout.slice("conv3.weight");
    double sum = 0.0, squares = 0.0;
    for (std::uint32_t i = 0; i < slice.count; ++i) {
        sum += values[slice.offset + i];
        squares += double(values[slice.offset + i]) * values[slice.offset + i];
    }
    // 36,864 samples: the standard error of the mean is 0.5 %, of the deviation 0.4 %, of one; 5
    // sigma each.
    const double deviation = std::sqrt(2.0 / 576);
    CHECK_LT(std::abs(sum / slice.count), 0.026 * deviation);
    CHECK_EQ(std::sqrt(squares / slice.count), doctest::Approx(deviation).epsilon(0.02));
    const ParameterSlice& bias = layout.slice("conv3.bias");
    for (std::uint32_t i = 0; i < bias.count; ++i)
        CHECK_EQ(values[bias.offset + i], 0.0f);
}

TEST_CASE("convolutions refuse what has no output")
{
    const Conv2dDesc conv{.in = 3, .out = 4, .kernel = {5, 5}, .padding = {1, 1}};
    CHECK_THROWS_AS((void)conv.output({1, 3, 2, 9}), Error);
    CHECK_THROWS_AS((void)conv.output({1, 4, 9, 9}), Error);
    CHECK_EQ(conv.output({1, 3, 3, 9}), TensorDesc{1, 4, 1, 7});
    const ConvTranspose2dDesc wide{.in = 3, .out = 4, .outputPadding = {2, 0}};
    CHECK_THROWS_AS((void)wide.output({1, 3, 4, 4}), Error);
    const ConvTranspose2dDesc onnx{.in = 3,
                                   .out = 4,
                                   .kernel = {3, 3},
                                   .stride = {3, 2},
                                   .padding = {1, 1},
                                   .outputPadding = {1, 1}};
    CHECK_EQ(onnx.output({1, 3, 7, 6}), TensorDesc{1, 4, 20, 12});
}
