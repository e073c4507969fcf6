// Shapes, sizes and parameter places of the networks, without a device.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "compute_nn/network_shapes.hpp"
#include "engine/base/error.hpp"

using namespace strandlight;

TEST_CASE("U-Net: every level has the size that its skip needs")
{
    for (const UNetDesc& net : {UNetDesc{}, hairUNet(HairUNetSize::Small), hairUNet(),
                                hairUNet(HairUNetSize::Large), benchmarkUNet()}) {
        const std::uint32_t side = 1u << net.levels();
        for (TensorDesc x : {TensorDesc{1, net.in, side, side}, TensorDesc{2, net.in, 48, 80},
                             TensorDesc{1, net.in, 384, 640}}) {
            net.check(x);
            TensorDesc skip = x;
            for (std::uint32_t l = net.head > 0 ? 0 : 1; l <= net.levels(); ++l) {
                skip = net.encoder(l).output(skip);
                CHECK_EQ(skip.c, net.skipChannels(l));
                CHECK_EQ(skip.h, net.level(l, x).h);
                CHECK_EQ(skip.w, net.level(l, x).w);
            }
            for (std::uint32_t l = net.levels(); l-- > 0;) {
                TensorDesc up = net.decoder(l).output(net.level(l + 1, x));
                up.c += net.skipChannels(l);
                CHECK_EQ(up, net.level(l, x));
            }
            CHECK_EQ(net.last().output(net.level(0, x)), TensorDesc{x.n, net.out, x.h, x.w});
        }
    }
    CHECK_THROWS_AS(UNetDesc{}.check({1, 24, 6, 8}), Error);
    CHECK_THROWS_AS(UNetDesc{}.check({1, 23, 8, 8}), Error);
    CHECK_THROWS_AS(UNetDesc{}.check({1, 24, 0, 8}), Error);
    CHECK_THROWS_AS(hairUNet().check({1, 27, 12, 16}), Error);
    CHECK_THROWS_AS((UNetDesc{.down = {8}, .up = {8, 8}}.check({1, 24, 8, 8})), Error);
    CHECK_THROWS_AS((UNetDesc{.upKernel = 3}.check({1, 24, 8, 8})), Error);
}

TEST_CASE("U-Net: layers of the hair network as its files name them")
{
    const ParameterLayout layout = hairUNet().parameters();
    std::vector<std::string> names;
    for (const ParameterSlice& slice : layout.slices())
        if (slice.name.ends_with(".weight"))
            names.push_back(slice.name.substr(0, slice.name.size() - 7));
    CHECK_EQ(names,
             std::vector<std::string>{"enc1", "enc2", "enc3", "dec2", "dec1", "dec0", "out"});
    using Shape = std::vector<std::uint64_t>;
    CHECK_EQ(layout.slice("enc1.weight").shape, Shape{32, 26, 3, 3});
    CHECK_EQ(layout.slice("dec2.weight").shape, Shape{64, 48, 2, 2});
    CHECK_EQ(layout.slice("dec0.weight").shape, Shape{64, 16, 2, 2});
    CHECK_EQ(layout.slice("out.weight").shape, Shape{12, 42, 3, 3});
    CHECK_EQ(benchmarkUNet().parameters().slice("dec0.weight").shape, Shape{32, 16, 4, 4});
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
