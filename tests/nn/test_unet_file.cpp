// Weight files: which network they hold, and what is said about those that hold none.
#include <doctest/doctest.h>

#include "compute_nn/unet_file.hpp"
#include "engine/base/error.hpp"
#include "tests/support/gpu_fixture.hpp"

#include "compute_nn/parameters.hpp"

using namespace strandlight;

namespace {

Safetensors fileOf(const UNetDesc& net)
{
    Safetensors file;
    const std::vector<float> values = net.parameters().initialValues(1);
    const ParameterLayout layout = net.parameters();
    for (const ParameterSlice& slice : layout.slices())
        file.tensors[slice.name] = {
            slice.shape,
            {values.begin() + slice.offset, values.begin() + slice.offset + slice.count}};
    return file;
}

} // namespace

TEST_CASE("weights: the network is read off the shapes")
{
    for (const UNetDesc& net : {UNetDesc{}, hairUNet(HairUNetSize::Small), hairUNet(),
                                hairUNet(HairUNetSize::Large), benchmarkUNet()}) {
        const UNetDesc read = unetOfFile(fileOf(net), "memory");
        CHECK_EQ(read.in, net.in);
        CHECK_EQ(read.out, net.out);
        CHECK_EQ(read.head, net.head);
        CHECK_EQ(read.down, net.down);
        CHECK_EQ(read.up, net.up);
        CHECK_EQ(read.upKernel, net.upKernel);
    }
}

TEST_CASE("weights: a wrong file is refused by tensor and shapes")
{
    const auto refused = [](auto&& change, const char* reason) {
        Safetensors file = fileOf(hairUNet());
        change(file);
        const auto load = [&] {
            const UNetDesc net = unetOfFile(file, "w.safetensors");
            Parameters(test::context(), net.parameters(), 0).load(file, "w.safetensors");
        };
        CHECK_THROWS_WITH_AS(load(), doctest::Contains(reason), FileError);
    };
    refused([](Safetensors& f) { f.tensors.clear(); }, "enc1.weight");
    refused([](Safetensors& f) { f.tensors.erase("dec1.weight"); }, "dec1.weight");
    refused([](Safetensors& f) { f.tensors.erase("dec1.bias"); }, "dec1.bias");
    refused([](Safetensors& f) { f.tensors.erase("enc3.weight"); }, "dec1.weight");
    refused(
        [](Safetensors& f) {
            f.tensors["enc2.weight"].shape = {48, 32, 9};
        },
        "has shape [48,32,9]");
    refused(
        [](Safetensors& f) {
            f.tensors["out.weight"] = {{12, 40, 3, 3}, std::vector<float>(12 * 40 * 9)};
        },
        "has shape [12,40,3,3], the network needs [12,42,3,3]");
    refused([](Safetensors& f) { f.tensors["dec0.weight"].shape = {64, 16, 1, 4}; }, "dec0.weight");
}
