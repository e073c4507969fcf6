#include "compute_nn/unet.hpp"

#include "compute_nn/adam.hpp"
#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"

namespace strandlight {

namespace {

// The two halves of a concatenation [up, skip].
TensorId upOf(const TensorId& both)
{
    return channelRange(both, 0, both.desc.c / 2);
}
TensorId skipOf(const TensorId& both)
{
    return channelRange(both, both.desc.c / 2, both.desc.c / 2);
}

} // namespace

UNetValues unetForward(RenderGraph& graph, const UNetDesc& net, const ParameterIds& parameters,
                       const TensorId& x)
{
    net.check(x.desc);
    const Activation leaky = Activation::leakyRelu(net.slope);
    const TensorDesc e0 = net.enc0().output(x.desc), e1 = net.enc1().output(e0);
    UNetValues v;
    v.x = x;
    v.cat0 = createTensor(graph, "cat0", {e0.n, 2 * e0.c, e0.h, e0.w});
    v.cat1 = createTensor(graph, "cat1", {e1.n, 2 * e1.c, e1.h, e1.w});
    v.enc2 = createTensor(graph, "enc2", net.enc2().output(e1));
    v.y = createTensor(graph, "y", net.last().output(v.cat0.desc));
    const auto weights = [&](const char* layer) { return parameters.weights(layer); };

    // Down.
    v.cat0 = v.cat0.as(
        conv2dForward(graph, "enc0", net.enc0(), x, weights("enc0"), skipOf(v.cat0), leaky).buffer);
    v.cat1 = v.cat1.as(conv2dForward(graph, "enc1", net.enc1(), skipOf(v.cat0), weights("enc1"),
                                     skipOf(v.cat1), leaky)
                           .buffer);
    v.enc2 =
        conv2dForward(graph, "enc2", net.enc2(), skipOf(v.cat1), weights("enc2"), v.enc2, leaky);
    // Up.
    v.cat1 = v.cat1.as(convTranspose2dForward(graph, "dec1", net.dec1(), v.enc2, weights("dec1"),
                                              upOf(v.cat1), leaky)
                           .buffer);
    v.cat0 = v.cat0.as(convTranspose2dForward(graph, "dec0", net.dec0(), v.cat1, weights("dec0"),
                                              upOf(v.cat0), leaky)
                           .buffer);
    v.y = conv2dForward(graph, "out", net.last(), v.cat0, weights("out"), v.y);
    return v;
}

void unetBackward(RenderGraph& graph, const UNetDesc& net, ParameterIds& parameters,
                  const UNetValues& v, const TensorId& dY)
{
    const auto weights = [&](const char* layer) { return parameters.weights(layer); };
    const auto gradients = [&](const char* layer) { return parameters.gradients(layer); };
    // Gradients before the activation (dZ), of both halves of each concatenation. The decoder's
    // half has one reader, so it is finished when that reader's data gradient is; the skip's half
    // gets a second part from the encoder below it, and only then goes back through the activation.
    TensorId dCat0 = createTensor(graph, "d cat0", v.cat0.desc);
    TensorId dCat1 = createTensor(graph, "d cat1", v.cat1.desc);
    TensorId dEnc2 = createTensor(graph, "d enc2", v.enc2.desc);
    const auto up = [&](const TensorId& cat) {
        return BackwardEpilogue{.activated = upOf(cat), .slope = net.slope};
    };
    const auto skipFirstPart = [&](const TensorId& cat) {
        return BackwardEpilogue{.firstInput = cat.desc.c / 2};
    };
    const auto skipSecondPart = [&](const TensorId& cat) {
        return BackwardEpilogue{.accumulate = true, .activated = skipOf(cat), .slope = net.slope};
    };
    const auto after = [](TensorId& cat, const TensorId& written) { cat = cat.as(written.buffer); };

    const Conv2dDesc out = net.last();
    parameters.gradient = conv2dBackwardWeight(graph, "out dW", out, v.cat0, dY, gradients("out"));
    after(dCat0,
          conv2dBackwardInput(graph, "out dUp", out, dY, weights("out"), upOf(dCat0), up(v.cat0)));
    after(dCat0, conv2dBackwardInput(graph, "out dSkip", out, dY, weights("out"), skipOf(dCat0),
                                     skipFirstPart(v.cat0)));

    const ConvTranspose2dDesc dec0 = net.dec0(), dec1 = net.dec1();
    parameters.gradient = convTranspose2dBackwardWeight(graph, "dec0 dW", dec0, v.cat1, upOf(dCat0),
                                                        gradients("dec0"));
    after(dCat1, convTranspose2dBackwardInput(graph, "dec0 dUp", dec0, upOf(dCat0), weights("dec0"),
                                              upOf(dCat1), up(v.cat1)));
    after(dCat1,
          convTranspose2dBackwardInput(graph, "dec0 dSkip", dec0, upOf(dCat0), weights("dec0"),
                                       skipOf(dCat1), skipFirstPart(v.cat1)));

    parameters.gradient = convTranspose2dBackwardWeight(graph, "dec1 dW", dec1, v.enc2, upOf(dCat1),
                                                        gradients("dec1"));
    dEnc2 = convTranspose2dBackwardInput(graph, "dec1 dX", dec1, upOf(dCat1), weights("dec1"),
                                         dEnc2, {.activated = v.enc2, .slope = net.slope});

    parameters.gradient = conv2dBackwardWeight(graph, "enc2 dW", net.enc2(), skipOf(v.cat1), dEnc2,
                                               gradients("enc2"));
    after(dCat1, conv2dBackwardInput(graph, "enc2 dX", net.enc2(), dEnc2, weights("enc2"),
                                     skipOf(dCat1), skipSecondPart(v.cat1)));

    parameters.gradient = conv2dBackwardWeight(graph, "enc1 dW", net.enc1(), skipOf(v.cat0),
                                               skipOf(dCat1), gradients("enc1"));
    after(dCat0, conv2dBackwardInput(graph, "enc1 dX", net.enc1(), skipOf(dCat1), weights("enc1"),
                                     skipOf(dCat0), skipSecondPart(v.cat0)));

    parameters.gradient =
        conv2dBackwardWeight(graph, "enc0 dW", net.enc0(), v.x, skipOf(dCat0), gradients("enc0"));
}

UNetStep addUNetTrainingStep(RenderGraph& graph, const UNetDesc& net, ParameterIds& parameters,
                             const TensorId& x, const TensorId& target, const AdamSettings& adam,
                             std::uint32_t step)
{
    parameters.clearGradients(graph);
    parameters.checkFinite(graph, "input", x);
    parameters.checkFinite(graph, "target", target);
    const UNetValues values = unetForward(graph, net, parameters, x);
    const LossResult loss = addLossPass(graph, "unet loss", LossKind::MeanSquare, values.y, target);
    unetBackward(graph, net, parameters, values, loss.gradient);
    addAdamPass(graph, parameters, adam, step);
    return {loss.value, values.y};
}

} // namespace strandlight
