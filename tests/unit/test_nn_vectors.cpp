// The CPU twins against PyTorch's numbers (float64 autograd, rounded to fp32 in the files).
#include <doctest/doctest.h>

#include <map>

#include "compute_nn/reference/adam.hpp"
#include "compute_nn/reference/conv2d.hpp"
#include "compute_nn/reference/loss.hpp"
#include "compute_nn/reference/networks.hpp"
#include "compute_nn/reference/sg_mixture.hpp"
#include "compute_nn/safetensors.hpp"
#include "tests/nn/compare.hpp"
#include "tests/nn/vectors.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

using Values = std::vector<double>;

Extent2 pairOf(const std::map<std::string, std::string>& metadata, const std::string& key)
{
    const auto value = std::uint32_t(std::stoul(metadata.at(key)));
    return {value, value};
}

} // namespace

TEST_CASE("PyTorch vectors: convolutions")
{
    const auto files = vectorFiles("conv");
    if (files.empty()) {
        MESSAGE("no shared vectors: skipped");
        return;
    }
    for (const auto& path : files) {
        CAPTURE(path.filename().string());
        const Safetensors file = Safetensors::load(path);
        const auto values = [&](const char* name) {
            return convert<double>(file.tensors.at(name).values);
        };
        const auto& s = file.tensors.at("x").shape;
        const TensorDesc x{std::uint32_t(s[0]), std::uint32_t(s[1]), std::uint32_t(s[2]),
                           std::uint32_t(s[3])};
        const bool transposed = file.metadata.at("op") == "conv_transpose2d";
        const Conv2dDesc conv{.in = x.c,
                              .out = std::uint32_t(values("bias").size()),
                              .kernel = pairOf(file.metadata, "kernel"),
                              .stride = pairOf(file.metadata, "stride"),
                              .padding = pairOf(file.metadata, "padding")};
        const ConvTranspose2dDesc transpose{.in = conv.in,
                                            .out = conv.out,
                                            .kernel = conv.kernel,
                                            .stride = conv.stride,
                                            .padding = conv.padding};
        const Values vx = values("x"), w = values("weight"), b = values("bias"), dY = values("dy");
        Values y(dY.size()), dX(vx.size(), 0.0), dW(w.size(), 0.0), dB(b.size(), 0.0);
        if (transposed) {
            reference::convTranspose2d<double>(transpose, x, vx, w, b, y);
            reference::convTranspose2dBackward<double>(transpose, x, vx, w, dY, dX, dW, dB);
        } else {
            reference::conv2d<double>(conv, x, vx, w, b, y);
            reference::conv2dBackward<double>(conv, x, vx, w, dY, dX, dW, dB);
        }
        // The file's inputs and results are rounded to fp32: 6e-8 each.
        CHECK_LE(relativeError(y, values("y")), 1e-6);
        CHECK_LE(relativeError(dX, values("dx")), 1e-6);
        CHECK_LE(relativeError(dW, values("dweight")), 1e-6);
        CHECK_LE(relativeError(dB, values("dbias")), 1e-6);
    }
}

TEST_CASE("PyTorch vectors: SG mixture and U-Net with ten Adam steps")
{
    if (vectorFiles("unet").empty() || vectorFiles("sg").empty()) {
        MESSAGE("no shared vectors: skipped");
        return;
    }
    const Safetensors sg = Safetensors::load(vectorFiles("sg").front());
    const Values raw = convert<double>(sg.tensors.at("raw").values);
    const Values directions = convert<double>(sg.tensors.at("directions").values);
    const Values target = convert<double>(sg.tensors.at("target").values);
    Values radiance(target.size(), 0.0), dRadiance(target.size(), 0.0), dRaw(raw.size(), 0.0);
    const auto each = [&](auto&& visit) {
        for (std::size_t n = 0; n < 6; ++n)
            for (std::size_t d = 0; d < 200; ++d)
                visit(n * 56, (n * 200 + d) * 3);
    };
    each([&](std::size_t r, std::size_t d) {
        reference::sgMixture<double>(std::span(raw).subspan(r, 56),
                                     std::span(directions).subspan(d, 3),
                                     std::span(radiance).subspan(d, 3));
    });
    const double loss =
        reference::loss<double>(LossKind::MeanSquare, radiance, target, {}, 1, dRadiance);
    each([&](std::size_t r, std::size_t d) {
        reference::sgMixtureBackward<double>(
            std::span(raw).subspan(r, 56), std::span(directions).subspan(d, 3),
            std::span(dRadiance).subspan(d, 3), std::span(dRaw).subspan(r, 56));
    });
    CHECK_LE(relativeError(radiance, convert<double>(sg.tensors.at("radiance").values)), 1e-6);
    CHECK_LE(relativeError(dRaw, convert<double>(sg.tensors.at("draw").values)), 1e-6);
    CHECK_EQ(loss, doctest::Approx(sg.tensors.at("loss").values[0]).epsilon(1e-6));

    const Safetensors file = Safetensors::load(vectorFiles("unet").front());
    const UNetDesc net;
    const ParameterLayout layout = net.parameters();
    Values parameters(layout.count()), gradient(layout.count());
    for (const ParameterSlice& slice : layout.slices())
        for (std::uint32_t i = 0; i < slice.count; ++i) {
            parameters[slice.offset + i] = file.tensors.at(slice.name).values[i];
            gradient[slice.offset + i] = file.tensors.at("d." + slice.name).values[i];
        }
    const Values x = convert<double>(file.tensors.at("x").values);
    const Values unetTarget = convert<double>(file.tensors.at("target").values);
    Values moment1(layout.count(), 0.0), moment2(layout.count(), 0.0);
    for (std::uint32_t step = 1; step <= 10; ++step) {
        const auto result =
            reference::unet<double>(net, parameters, {2, 24, 24, 40}, x, unetTarget);
        if (step == 1) {
            CHECK_LE(relativeError(result.output, file.tensors.at("y").values), 1e-6);
            CHECK_LE(relativeError(result.gradient, gradient), 1e-6);
        }
        CHECK_EQ(result.loss,
                 doctest::Approx(file.tensors.at("losses").values[step - 1]).epsilon(1e-6));
        REQUIRE(
            reference::adamStep<double>({}, step, result.gradient, parameters, moment1, moment2));
    }
}
