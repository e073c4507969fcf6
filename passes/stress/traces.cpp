// Training under stress: twenty steps of the encoder and of a small U-Net from random numbers,
// against the double twins.
#include <cmath>

#include "compute_nn/encoder.hpp"
#include "compute_nn/reference/adam.hpp"
#include "compute_nn/reference/networks.hpp"
#include "compute_nn/unet.hpp"
#include "passes/stress/inputs.hpp"
#include "passes/stress/kernel_inputs.hpp"
#include "passes/stress/tally.hpp"

namespace strandlight {

namespace {

constexpr std::uint32_t kTraceSteps = 20;
constexpr double kTraceTolerance = 1e-4;

// The twin's parameters and moments.
struct Twin
{
    explicit Twin(const std::vector<float>& start)
        : values(toDouble(start)), m(values.size(), 0.0), v(values.size(), 0.0)
    {
    }
    void step(std::uint32_t step, const std::vector<double>& gradient)
    {
        (void)reference::adamStep<double>({}, step, gradient, values, m, v);
    }
    std::vector<double> values, m, v;
};

void traceEncoder(Context& context, std::uint32_t seed, Tally& tally)
{
    const EncoderDesc net{.imageSize = 8, .lobes = 3};
    constexpr std::uint32_t kImages = 4;
    std::vector<float> image, along;
    for (std::uint32_t i = 0; i < net.input(kImages).elements(); ++i)
        image.push_back(StressRandom(seed, i).logUniform(1e-3f, 30.0f));
    for (std::uint32_t d = 0; d < 64; ++d) {
        const glm::vec3 v = StressRandom(seed + 1, d).direction();
        along.insert(along.end(), {v.x, v.y, v.z});
    }
    Parameters parameters(context, net.parameters(), seed);
    Twin twin(net.parameters().initialValues(seed));
    for (std::uint32_t step = 1; step <= kTraceSteps; ++step) {
        RenderGraph graph(context);
        ParameterIds ids(graph, parameters);
        const EncoderStep result = addEncoderTrainingStep(
            graph, net, ids, uploadTensor(graph, "image", net.input(kImages), image),
            graph.uploadBuffer("along", std::span<const float>(along)), {}, step);
        graph.output(result.loss);
        graph.run();
        const auto expected = reference::encoder<double>(net, twin.values, kImages, toDouble(image),
                                                         toDouble(along), {}, LossKind::Log1p);
        twin.step(step, expected.gradient);
        tally.compare(double(graph.read<float>(result.loss)[0]), expected.loss, expected.loss,
                      [&] { return "step " + std::to_string(step); });
    }
}

void traceUNet(Context& context, std::uint32_t seed, Tally& tally)
{
    UNetDesc net;
    net.in = 5;
    net.head = 6;
    net.down = {8, 12};
    net.up = {8, 6};
    const TensorDesc xDesc{2, 5, 8, 12}, yDesc{2, 3, 8, 12};
    const std::vector<float> x = stressTensor(xDesc.elements(), seed);
    const std::vector<float> target = stressTensor(yDesc.elements(), seed + 1);
    Parameters parameters(context, net.parameters(), seed);
    Twin twin(net.parameters().initialValues(seed));
    for (std::uint32_t step = 1; step <= kTraceSteps; ++step) {
        RenderGraph graph(context);
        ParameterIds ids(graph, parameters);
        const UNetStep result =
            addUNetTrainingStep(graph, net, ids, uploadTensor(graph, "x", xDesc, x),
                                uploadTensor(graph, "target", yDesc, target), {}, step);
        graph.output(result.loss);
        graph.run();
        const auto expected =
            reference::unet<double>(net, twin.values, xDesc, toDouble(x), toDouble(target));
        twin.step(step, expected.gradient);
        tally.compare(double(graph.read<float>(result.loss)[0]), expected.loss, expected.loss,
                      [&] { return "step " + std::to_string(step); });
    }
}

} // namespace

std::vector<StressRow> stressTraces(Context& context, const StressSettings& settings)
{
    Tally encoder("loss of the encoder, 20 steps, device", kTraceTolerance,
                  "loss of the double twin");
    Tally unet("loss of a U-Net, 20 steps, device", kTraceTolerance, "loss of the double twin");
    traceEncoder(context, settings.seed + 120, encoder);
    traceUNet(context, settings.seed + 121, unet);
    return {encoder.row(), unet.row()};
}

} // namespace strandlight
