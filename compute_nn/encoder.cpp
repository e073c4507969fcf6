#include "compute_nn/encoder.hpp"

#include <limits>
#include <string>

#include "compute_nn/activation.hpp"
#include "compute_nn/adam.hpp"
#include "compute_nn/conv2d.hpp"
#include "compute_nn/sg_mixture.hpp"

namespace strandlight {

namespace {

std::string layerName(std::uint32_t index)
{
    return "conv" + std::to_string(index);
}

} // namespace

EncoderValues encoderForward(RenderGraph& graph, const EncoderDesc& net,
                             const ParameterIds& parameters, const TensorId& image)
{
    const Activation leaky = Activation::leakyRelu(net.slope);
    EncoderValues values;
    TensorId* f = values.features.data();
    f[0] =
        log1pForward(graph, "encoder input", image, createTensor(graph, "log image", image.desc));
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::string name = layerName(i);
        f[i + 1] = createTensor(graph, name, net.layer(i).output(f[i].desc, name));
        f[i + 1] = conv2dForward(graph, name, net.layer(i), f[i], parameters.weights(name),
                                 f[i + 1], leaky);
    }
    values.raw = createTensor(graph, "raw lobes", net.head().output(f[4].desc, "head"));
    values.raw =
        conv2dForward(graph, "head", net.head(), f[4], parameters.weights("head"), values.raw);
    return values;
}

void encoderBackward(RenderGraph& graph, const EncoderDesc& net, ParameterIds& parameters,
                     const EncoderValues& values, const TensorId& dRaw)
{
    // From layer to layer goes dZ, the gradient before the activation: the data gradient of a layer
    // ends with the derivative of the activation below it.
    const auto& f = values.features;
    parameters.gradient = conv2dBackwardWeight(graph, "head dW", net.head(), f[4], dRaw,
                                               parameters.gradients("head"));
    TensorId dZ = conv2dBackwardInput(
        graph, "head dX", net.head(), dRaw, parameters.weights("head"),
        createTensor(graph, "d conv3", f[4].desc), {.activated = f[4], .slope = net.slope});
    for (std::uint32_t i = 4; i-- > 0;) {
        const std::string name = layerName(i);
        parameters.gradient = conv2dBackwardWeight(graph, name + " dW", net.layer(i), f[i], dZ,
                                                   parameters.gradients(name));
        if (i > 0) // the image needs no gradient
            dZ =
                conv2dBackwardInput(graph, name + " dX", net.layer(i), dZ, parameters.weights(name),
                                    createTensor(graph, "d " + layerName(i - 1), f[i].desc),
                                    {.activated = f[i], .slope = net.slope});
    }
}

EncoderStep addEncoderTrainingStep(RenderGraph& graph, const EncoderDesc& net,
                                   ParameterIds& parameters, const TensorId& image,
                                   BufferId directions, const EncoderTraining& training,
                                   std::uint32_t step)
{
    const SgMixtureDesc mixture{
        .images = image.desc.n, .lobes = net.lobes, .directions = net.imageSize * net.imageSize};
    parameters.clearGradients(graph);
    parameters.checkFinite(graph, "light-field image", image);
    constexpr float kAnyFinite = std::numeric_limits<float>::max();
    parameters.checkFinite(graph, "directions", directions, 0, 3 * mixture.directions, kAnyFinite);
    if (training.weights)
        parameters.checkFinite(graph, "loss weights", training.weights->buffer, 0,
                               training.weights->count, kAnyFinite);

    const EncoderValues values = encoderForward(graph, net, parameters, image);
    const TensorId lobes = addSgDecodePass(graph, mixture, values.raw);
    const TensorId radiance = sgMixtureForward(graph, mixture, lobes, directions,
                                               createTensor(graph, "radiance", image.desc));
    const LossResult loss =
        addLossPass(graph, "encoder loss", training.loss, radiance, image, training.weights);

    const TensorId dRaw = sgMixtureBackward(graph, mixture, values.raw, directions, loss.gradient,
                                            createTensor(graph, "d raw", values.raw.desc));
    encoderBackward(graph, net, parameters, values, dRaw);
    addAdamPass(graph, parameters, training.adam, step);
    return {loss.value, values.raw, radiance};
}

} // namespace strandlight
