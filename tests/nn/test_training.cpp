// Networks: training traces against the twins, repeatability, and what happens to poisoned inputs.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "compute_nn/activation.hpp"
#include "compute_nn/encoder.hpp"
#include "compute_nn/reference/adam.hpp"
#include "compute_nn/reference/networks.hpp"
#include "compute_nn/unet.hpp"
#include "engine/base/error.hpp"
#include "tests/nn/compare.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

constexpr std::uint32_t kSteps = 20;
// The bar for a trace; measured below 1e-5.
constexpr double kTraceTolerance = 1e-4;

const EncoderDesc kEncoder{.imageSize = 8, .lobes = 3};
constexpr std::uint32_t kImages = 6;

std::vector<float> encoderImage()
{
    return randomValues<float>(kImages * 3 * 64, 70, 0.0f, 4.0f);
}

std::vector<float> encoderDirections()
{
    std::vector<float> v = randomValues<float>(64 * 3, 71);
    for (std::size_t d = 0; d < 64; ++d) {
        const double length = std::hypot(double(v[3 * d]), v[3 * d + 1], v[3 * d + 2]);
        for (std::size_t k = 0; k < 3; ++k)
            v[3 * d + k] = float(v[3 * d + k] / length);
    }
    return v;
}

float trainEncoder(Parameters& parameters, const std::vector<float>& image, LossKind kind,
                   std::uint32_t step)
{
    RenderGraph graph(context());
    ParameterIds ids(graph, parameters);
    const std::vector<float> along = encoderDirections();
    const std::vector<float> weights = randomValues<float>(64, 72, 0.5f, 1.5f);
    const EncoderTraining training{
        .loss = kind,
        .adam = {},
        .weights = LossWeights{graph.uploadBuffer("weights", std::span(weights)), 64, 1}};
    const EncoderStep result = addEncoderTrainingStep(
        graph, kEncoder, ids, uploadTensor(graph, "image", kEncoder.input(kImages), image),
        graph.uploadBuffer("directions", std::span(along)), training, step);
    graph.output(result.loss);
    graph.execute();
    return graph.read<float>(result.loss)[0];
}

} // namespace

TEST_CASE("encoder: twenty training steps follow the twin, and two runs have the same bits")
{
    for (LossKind kind : {LossKind::Log1p, LossKind::Relative}) {
        Parameters first(context(), kEncoder.parameters(), 5),
            second(context(), kEncoder.parameters(), 5);
        std::vector<double> values = convert<double>(kEncoder.parameters().initialValues(5));
        std::vector<double> m(values.size(), 0.0), v(values.size(), 0.0);
        double last = 0.0, begin = 0.0;
        for (std::uint32_t step = 1; step <= kSteps; ++step) {
            const auto expected = reference::encoder<double>(
                kEncoder, values, kImages, convert<double>(encoderImage()),
                convert<double>(encoderDirections()), randomValues<double>(64, 72, 0.5f, 1.5f),
                kind);
            const float loss = trainEncoder(first, encoderImage(), kind, step);
            CHECK_EQ(loss, doctest::Approx(expected.loss).epsilon(kTraceTolerance));
            CHECK_EQ(loss, trainEncoder(second, encoderImage(), kind, step));
            REQUIRE(reference::adamStep<double>({}, step, expected.gradient, values, m, v));
            last = expected.loss;
            begin = step == 1 ? last : begin;
        }
        CHECK_LT(last, 0.9 * begin); // it learns
        CHECK_EQ(first.download(), second.download());
        CHECK_EQ(first.report().stepsTaken, kSteps);
    }
}

TEST_CASE("U-Net: training steps follow the twin, whatever the levels")
{
    for (const UNetDesc& net : {UNetDesc{}, hairUNet(HairUNetSize::Small), benchmarkUNet()}) {
        const std::uint32_t side = 1u << net.levels();
        const TensorDesc xDesc{2, net.in, side, 2 * side}, yDesc{2, net.out, side, 2 * side};
        CAPTURE(shapeText(xDesc));
        const std::vector<float> x = randomValues<float>(xDesc.elements(), 80, 0.0f, 1.0f);
        const std::vector<float> target = randomValues<float>(yDesc.elements(), 81, 0.0f, 1.0f);
        Parameters parameters(context(), net.parameters(), 9);
        std::vector<double> values = convert<double>(net.parameters().initialValues(9));
        std::vector<double> m(values.size(), 0.0), v(values.size(), 0.0);
        const std::uint32_t steps = net.levels() == 2 ? kSteps : 5; // the twin takes its time
        for (std::uint32_t step = 1; step <= steps; ++step) {
            RenderGraph graph(context());
            ParameterIds ids(graph, parameters);
            const UNetStep result =
                addUNetTrainingStep(graph, net, ids, uploadTensor(graph, "x", xDesc, x),
                                    uploadTensor(graph, "target", yDesc, target), {}, step);
            graph.output(result.loss);
            graph.execute();
            const auto expected = reference::unet<double>(net, values, xDesc, convert<double>(x),
                                                          convert<double>(target));
            CHECK_EQ(graph.read<float>(result.loss)[0],
                     doctest::Approx(expected.loss).epsilon(kTraceTolerance));
            REQUIRE(reference::adamStep<double>({}, step, expected.gradient, values, m, v));
        }
        CHECK_LE(relativeError(parameters.download(), values), 1e-4);
    }
}

TEST_CASE("U-Net: without a head, an input written in place gives the bits of a copied one")
{
    const UNetDesc net = hairUNet(HairUNetSize::Small);
    const TensorDesc xDesc{2, net.in, 8, 16};
    Parameters parameters(context(), net.parameters(), 9);
    const std::vector<float> x = randomValues<float>(xDesc.elements(), 83, 0.0f, 1.0f);
    const auto run = [&](bool inPlace) {
        RenderGraph graph(context());
        const ParameterIds ids(graph, parameters);
        TensorId input = uploadTensor(graph, "x", xDesc, x);
        if (inPlace)
            input = activationForward(graph, "fill", Activation::none(), input,
                                      createUNetInput(graph, net, xDesc));
        const UNetValues values = unetForward(graph, net, ids, input);
        CHECK_EQ(values.levels[0].buffer.index == input.buffer.index, inPlace);
        graph.output(values.y.buffer);
        graph.execute();
        return graph.read<float>(values.y.buffer);
    };
    CHECK_EQ(run(true), run(false));
}

TEST_CASE("U-Net: one bright pixel changes nothing outside its receptive field")
{
    // An output pixel sees 8 pixels up and left and 5 down and right: out (1), two strided levels
    // (4 r - 4 .. 4 r + 4).
    constexpr int kRadius = 8;
    const UNetDesc net;
    const TensorDesc xDesc{1, 24, 32, 40};
    Parameters parameters(context(), net.parameters(), 9);
    std::vector<float> x = randomValues<float>(xDesc.elements(), 82, 0.0f, 1.0f);
    const auto run = [&] {
        RenderGraph graph(context());
        const ParameterIds ids(graph, parameters);
        const UNetValues values = unetForward(graph, net, ids, uploadTensor(graph, "x", xDesc, x));
        graph.output(values.y.buffer);
        graph.execute();
        return graph.read<float>(values.y.buffer);
    };
    const std::vector<float> calm = run();
    constexpr int kY = 17, kX = 21;
    x[std::size_t(5 * 32 + kY) * 40 + kX] = 1e6f;
    const std::vector<float> bright = run();
    std::uint32_t changed = 0, leaked = 0;
    for (int i = 0; i < int(calm.size()); ++i) {
        const int py = i / 40 % 32, px = i % 40;
        const bool differs = calm[std::size_t(i)] != bright[std::size_t(i)];
        changed += differs;
        leaked += differs && (std::abs(py - kY) > kRadius || std::abs(px - kX) > kRadius);
    }
    CHECK_GT(changed, 0);
    CHECK_EQ(leaked, 0);
}

TEST_CASE("NaN and infinity in an input are found, named, and never reach the weights")
{
    Parameters parameters(context(), kEncoder.parameters(), 5);
    (void)trainEncoder(parameters, encoderImage(), LossKind::Log1p, 1);
    const std::vector<float> before = parameters.download();
    std::uint32_t skipped = 0;
    for (float poison :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
          -std::numeric_limits<float>::infinity()}) {
        std::vector<float> image = encoderImage();
        image[517] = poison;
        (void)trainEncoder(parameters, image, LossKind::Log1p, 2);
        CHECK_EQ(parameters.download(), before);
        const OptimizerReport report = parameters.report();
        CHECK_EQ(report.stepsTaken, 1);
        CHECK_EQ(report.stepsSkipped, ++skipped);
        REQUIRE_FALSE(report.refusedIn.empty());
        CHECK_EQ(report.refusedIn[0], "light-field image");
        CHECK_EQ(report.refused[0], skipped);
    }
    // A finite input whose gradient overflows is refused by the gradient's own check.
    std::vector<float> bright = encoderImage();
    bright[3] = 1e30f;
    (void)trainEncoder(parameters, bright, LossKind::MeanSquare, 2);
    CHECK_EQ(parameters.download(), before);
    CHECK_EQ(parameters.report().refusedIn.back(), "gradient");

    (void)trainEncoder(parameters, encoderImage(), LossKind::Log1p, 2); // and training goes on
    CHECK_NE(parameters.download(), before);
    CHECK_EQ(parameters.report().stepsTaken, 2);
}

TEST_CASE("parameters: saved and loaded with their moments, training goes on with the same bits")
{
    Parameters a(context(), kEncoder.parameters(), 5), b(context(), kEncoder.parameters(), 6);
    (void)trainEncoder(a, encoderImage(), LossKind::Log1p, 1);
    Safetensors file;
    a.save(file, true);
    b.load(file, "memory");
    CHECK_EQ(a.download(), b.download());
    (void)trainEncoder(a, encoderImage(), LossKind::Log1p, 2);
    (void)trainEncoder(b, encoderImage(), LossKind::Log1p, 2);
    CHECK_EQ(a.download(), b.download());

    file.tensors["conv1.weight"].values[3] = NAN;
    CHECK_THROWS_AS(b.load(file, "memory"), FileError);
    file.tensors.erase("conv1.weight");
    CHECK_THROWS_AS(b.load(file, "memory"), FileError);
    CHECK_EQ(a.download(), b.download()); // refused as a whole
}
