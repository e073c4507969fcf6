// One NaN or infinity in any input tensor: found and named before the optimiser's step, and no
// kernel swallows it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "compute_nn/activation.hpp"
#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"
#include "compute_nn/encoder.hpp"
#include "compute_nn/sg_mixture.hpp"
#include "compute_nn/unet.hpp"
#include "tests/nn/compare.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

const float kPoisons[] = {NAN, INFINITY, -INFINITY};

const EncoderDesc kNet{.imageSize = 8, .lobes = 3};
constexpr std::uint32_t kImages = 3;

std::vector<float> unitDirections(std::uint32_t count)
{
    std::vector<float> v = randomValues<float>(count * 3, 71);
    for (std::size_t d = 0; d < count; ++d) {
        const float length = std::hypot(v[3 * d], v[3 * d + 1], v[3 * d + 2]);
        for (std::size_t k = 0; k < 3; ++k)
            v[3 * d + k] /= length;
    }
    return v;
}

// The inputs of one training step, by the names that the report must give them.
struct StepInputs
{
    std::vector<float> image = randomValues<float>(kImages * 192, 70, 0.0f, 4.0f);
    std::vector<float> directions = unitDirections(64);
    std::vector<float> weights = randomValues<float>(64, 72, 0.5f, 1.5f);
};

void encoderStep(Parameters& parameters, const StepInputs& in, std::uint32_t step)
{
    RenderGraph graph(context());
    ParameterIds ids(graph, parameters);
    EncoderTraining training;
    training.weights = LossWeights{graph.uploadBuffer("w", std::span(in.weights)), 64, 1};
    const EncoderStep result = addEncoderTrainingStep(
        graph, kNet, ids, uploadTensor(graph, "image", kNet.input(kImages), in.image),
        graph.uploadBuffer("d", std::span(in.directions)), training, step);
    graph.output(result.loss);
    graph.run();
}

bool names(const OptimizerReport& report, const std::string& tensor)
{
    return std::find(report.refusedIn.begin(), report.refusedIn.end(), tensor) !=
           report.refusedIn.end();
}

// Values that are not finite, of a tensor that a graph computed.
std::size_t nonFinite(const std::vector<float>& values)
{
    return std::size_t(
        std::count_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); }));
}

// Everything of the parameters that a step could change.
Safetensors snapshot(const Parameters& parameters)
{
    Safetensors file;
    parameters.save(file, true);
    return file;
}

bool sameBits(const Safetensors& a, const Safetensors& b)
{
    for (const auto& [name, tensor] : a.tensors)
        if (std::memcmp(tensor.values.data(), b.tensors.at(name).values.data(),
                        tensor.values.size() * sizeof(float)) != 0)
            return false;
    return a.tensors.size() == b.tensors.size();
}

} // namespace

TEST_CASE("injection: each input of an encoder step is named, and nothing changes")
{
    for (const float poison : kPoisons)
        for (const std::string name : {"light-field image", "directions", "loss weights"}) {
            CAPTURE(name);
            CAPTURE(poison);
            Parameters parameters(context(), kNet.parameters(), 5);
            encoderStep(parameters, {}, 1);
            const Safetensors before = snapshot(parameters);
            StepInputs in;
            auto& tensor = name == "directions"     ? in.directions
                           : name == "loss weights" ? in.weights
                                                    : in.image;
            tensor[tensor.size() / 3] = poison;
            encoderStep(parameters, in, 2);
            CHECK(sameBits(snapshot(parameters), before));
            CHECK_EQ(parameters.report().stepsSkipped, 1);
            CHECK(names(parameters.report(), name));
            encoderStep(parameters, {}, 2); // and training goes on
            CHECK_EQ(parameters.report().stepsTaken, 2);
        }
}

TEST_CASE("injection: a parameter that is not finite stops training by name, also behind a clamp")
{
    for (const float poison : kPoisons)
        // The head's fourth bias is a lobe's raw sharpness, which the decoder clamps.
        for (const std::string slice : {"conv0.weight", "conv2.bias", "head.weight", "head.bias"}) {
            CAPTURE(slice);
            CAPTURE(poison);
            Parameters parameters(context(), kNet.parameters(), 5);
            std::vector<float> values = parameters.download();
            values[parameters.layout().slice(slice).offset + 3] = poison;
            parameters.upload(values);
            const Safetensors before = snapshot(parameters);
            encoderStep(parameters, {}, 1);
            CHECK(sameBits(snapshot(parameters), before));
            CHECK_EQ(parameters.report().stepsTaken, 0);
            CHECK(names(parameters.report(), "parameters"));
        }
}

TEST_CASE("injection: U-Net, input and target")
{
    UNetDesc net;
    net.in = 4;
    net.head = 4;
    net.down = {6, 8};
    net.up = {6, 4};
    const TensorDesc xDesc{1, 4, 8, 8}, yDesc{1, 3, 8, 8};
    for (const float poison : kPoisons)
        for (const bool inTarget : {false, true}) {
            Parameters parameters(context(), net.parameters(), 9);
            const std::vector<float> before = parameters.download();
            std::vector<float> x = randomValues<float>(xDesc.elements(), 80);
            std::vector<float> target = randomValues<float>(yDesc.elements(), 81);
            (inTarget ? target : x)[77] = poison;
            RenderGraph graph(context());
            ParameterIds ids(graph, parameters);
            const UNetStep result =
                addUNetTrainingStep(graph, net, ids, uploadTensor(graph, "x", xDesc, x),
                                    uploadTensor(graph, "target", yDesc, target), {}, 1);
            graph.output(result.loss);
            graph.run();
            CHECK_EQ(parameters.download(), before);
            CHECK_EQ(parameters.report().stepsSkipped, 1);
            CHECK(names(parameters.report(), inTarget ? "target" : "input"));
        }
}

TEST_CASE("injection: every kernel passes a NaN of each of its inputs on")
{
    const Conv2dDesc conv{.in = 3, .out = 5};
    const ConvTranspose2dDesc transpose{.in = 3, .out = 5};
    const SgMixtureDesc mixture{.images = 2, .lobes = 3, .directions = 16};
    const TensorDesc x{2, 3, 6, 6}, y{2, 5, 6, 6}, wide{2, 5, 12, 12}, rgb{2, 3, 1, 16};
    for (const int poisoned : {0, 1, 2}) { // x, weights or raw lobes, gradient of the output
        CAPTURE(poisoned);
        RenderGraph graph(context());
        const auto tensor = [&](const TensorDesc& desc, std::uint32_t seed, bool poison) {
            std::vector<float> values = randomValues<float>(desc.elements(), seed);
            if (poison)
                values[values.size() / 2] = NAN;
            return uploadTensor(graph, "t", desc, values);
        };
        const TensorId image = tensor(x, 1, poisoned == 0), dY = tensor(y, 3, poisoned == 2);
        const TensorId dWide = tensor(wide, 4, poisoned == 2);
        const TensorId raw = tensor(mixture.raw(), 5, poisoned == 1);
        const TensorId dRgb = tensor(rgb, 6, poisoned == 2);
        std::vector<float> along = unitDirections(16);
        along[7] = poisoned == 0 ? NAN : along[7];
        const BufferId list = graph.uploadBuffer("along", std::span<const float>(along));
        const TensorId block = tensor({1, 1, 1, 200}, 2, false),
                       zeros = tensor({1, 1, 1, 200}, 2, false);
        std::vector<float> parameters = randomValues<float>(200, 2);
        parameters[40] = poisoned == 1 ? NAN : parameters[40]; // a weight of both layers
        const LayerWeights w{graph.uploadBuffer("w", std::span<const float>(parameters)), 0, 180,
                             true};
        const LayerWeights dW{block.buffer, 0, 180, true}, dV{zeros.buffer, 0, 180, true};

        // Which of the inputs each result depends on: x, weights, output gradient.
        struct Result
        {
            std::string name;
            BufferId buffer;
            bool reads[3];
        };
        const auto made = [&](const TensorDesc& d) { return createTensor(graph, "r", d); };
        const std::vector<Result> results = {
            {"conv",
             conv2dForward(graph, "a", conv, image, w, made(y), Activation::leakyRelu(0.1f)).buffer,
             {true, true, false}},
            {"conv dX",
             conv2dBackwardInput(graph, "b", conv, dY, w, made(x)).buffer,
             {false, true, true}},
            {"conv dW", conv2dBackwardWeight(graph, "c", conv, image, dY, dW), {true, false, true}},
            {"transposed",
             convTranspose2dForward(graph, "d", transpose, image, w, made(wide)).buffer,
             {true, true, false}},
            {"transposed dX",
             convTranspose2dBackwardInput(graph, "e", transpose, dWide, w, made(x)).buffer,
             {false, true, true}},
            {"transposed dW",
             convTranspose2dBackwardWeight(graph, "f", transpose, image, dWide, dV),
             {true, false, true}},
            {"mixture",
             sgMixtureForward(graph, mixture, addSgDecodePass(graph, mixture, raw), list, made(rgb))
                 .buffer,
             {true, true, false}},
            {"mixture dRaw",
             sgMixtureBackward(graph, mixture, raw, list, dRgb, made(mixture.raw())).buffer,
             {true, true, true}},
            {"log", log1pForward(graph, "g", image, made(x)).buffer, {true, false, false}},
        };
        for (const Result& result : results)
            graph.output(result.buffer);
        graph.run();
        for (const Result& result : results) {
            CAPTURE(result.name);
            const std::size_t found = nonFinite(graph.read<float>(result.buffer));
            CHECK_EQ(found > 0, result.reads[poisoned]);
        }
    }
}
