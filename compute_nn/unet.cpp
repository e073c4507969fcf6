#include "compute_nn/unet.hpp"

#include <string>

#include "compute_nn/activation.hpp"
#include "compute_nn/adam.hpp"
#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"

namespace strandlight {

namespace {

std::string layerName(const char* kind, std::uint32_t level)
{
    return kind + std::to_string(level);
}

// A tensor that layers write in parts. Halves are cleared: a layer over tiles also reads what no
// tile has written, and the guard would take what was left there for overflow.
TensorId createLevel(RenderGraph& graph, const std::string& name, const TensorDesc& desc,
                     Element element)
{
    TensorId level = createTensor(graph, name, desc, element);
    if (element == Element::Half) {
        PassBuilder pass = graph.addTransferPass("clear " + name);
        level = level.as(pass.write(level.buffer));
        pass.fill(level.buffer, 0);
    }
    return level;
}

// The two parts of a level, [up, skip].
TensorId upOf(const UNetDesc& net, const std::vector<TensorId>& levels, std::uint32_t level)
{
    return channelRange(levels[level], 0, net.upChannels(level));
}
TensorId skipOf(const UNetDesc& net, const std::vector<TensorId>& levels, std::uint32_t level)
{
    return channelRange(levels[level], net.upChannels(level), net.skipChannels(level));
}

void written(TensorId& level, const TensorId& part)
{
    level = level.as(part.buffer);
}

bool isRangeOfLevel0(const UNetDesc& net, const TensorId& x)
{
    return x.firstChannel == net.upChannels(0) && x.bufferChannels == net.channels(0);
}

// Level 0 of a network without a head, with x as its skip.
TensorId levelOfInput(RenderGraph& graph, const UNetDesc& net, const TensorId& x)
{
    TensorId level{x.buffer, net.level(0, x.desc), 0, net.channels(0)};
    level.element = x.element;
    if (isRangeOfLevel0(net, x))
        return level;
    const TensorId room = createUNetInput(graph, net, x.desc);
    written(level, activationForward(graph, "input to level 0", Activation::none(), x, room));
    return level;
}

// From enc`first` down, and all the way up again.
void addInnerLayers(RenderGraph& graph, const UNetDesc& net, const ParameterIds& parameters,
                    std::vector<TensorId>& f, std::uint32_t first, const UNetTiles* tiles,
                    HalfGuard* halves)
{
    const Activation leaky = Activation::leakyRelu(net.slope);
    for (std::uint32_t l = first; l <= net.levels(); ++l) {
        const std::string name = layerName("enc", l);
        written(f[l], conv2dForward(graph, name, net.encoder(l), skipOf(net, f, l - 1),
                                    parameters.weights(name), skipOf(net, f, l), leaky,
                                    tiles ? &tiles->skip[l] : nullptr, halves));
    }
    for (std::uint32_t l = net.levels(); l-- > 0;) {
        const std::string name = layerName("dec", l);
        written(f[l], convTranspose2dForward(graph, name, net.decoder(l), f[l + 1],
                                             parameters.weights(name), upOf(net, f, l), leaky,
                                             tiles ? &tiles->up[l] : nullptr, halves));
    }
}

} // namespace

TensorId createUNetInput(RenderGraph& graph, const UNetDesc& net, const TensorDesc& x,
                         Element element)
{
    net.check(x);
    if (net.head > 0)
        return createLevel(graph, "unet input", x, element);
    const TensorId level = createLevel(graph, "level 0", net.level(0, x), element);
    return channelRange(level, net.upChannels(0), net.in);
}

UNetValues unetForward(RenderGraph& graph, const UNetDesc& net, const ParameterIds& parameters,
                       const TensorId& input, const UNetTiles* tiles, HalfGuard* halves)
{
    net.check(input.desc);
    const Element element = halves ? Element::Half : Element::Float;
    const TensorId x = input.element == element
                           ? input
                           : storeAsHalves(graph, "input as halves", input,
                                           createUNetInput(graph, net, input.desc, element));
    const Activation leaky = Activation::leakyRelu(net.slope);
    UNetValues v;
    std::vector<TensorId>& f = v.levels;
    v.x = x;
    for (std::uint32_t l = 0; l <= net.levels(); ++l)
        f.push_back(l == 0 && net.head == 0 ? levelOfInput(graph, net, x)
                                            : createLevel(graph, layerName("level ", l),
                                                          net.level(l, x.desc), element));

    if (net.head > 0)
        written(f[0],
                conv2dForward(graph, "enc0", net.encoder(0), x, parameters.weights("enc0"),
                              skipOf(net, f, 0), leaky, tiles ? &tiles->skip[0] : nullptr, halves));
    addInnerLayers(graph, net, parameters, f, 1, tiles, halves);
    v.y = createTensor(graph, "y", net.last().output(f[0].desc));
    v.y = conv2dForward(graph, "out", net.last(), f[0], parameters.weights("out"), v.y, {},
                        tiles ? &tiles->y : nullptr);
    return v;
}

TensorId unetForward(RenderGraph& graph, const UNetDesc& net, const ParameterIds& parameters,
                     const UNetFetch& input, const UNetTiles* tiles, HalfGuard* halves)
{
    net.check(input.x);
    const Element element = halves ? Element::Half : Element::Float;
    std::vector<TensorId> f;
    for (std::uint32_t l = 0; l <= net.levels(); ++l) {
        TensorDesc desc = net.level(l, input.x);
        if (l == 0 && net.head == 0) // its skip is not stored
            desc.c = net.upChannels(0);
        f.push_back(createLevel(graph, layerName("level ", l), desc, element));
    }
    const std::uint32_t first = net.head > 0 ? 0 : 1;
    const std::string name = layerName("enc", first);
    written(f[first],
            input.convolve(name,
                           forwardPass(net.encoder(first), parameters.weights(name).hasBias,
                                       Activation::leakyRelu(net.slope),
                                       tiles ? &tiles->skip[first] : nullptr, halves),
                           false, parameters.weights(name), skipOf(net, f, first)));
    addInnerLayers(graph, net, parameters, f, first + 1, tiles, halves);

    const TensorDesc whole = net.level(0, input.x);
    const TensorId y = createTensor(graph, "y", net.last().output(whole));
    const TileList* list = tiles ? &tiles->y : nullptr;
    LayerWeights weights = parameters.weights("out");
    if (net.head > 0)
        return conv2dForward(graph, "out", net.last(), f[0], weights, y, {}, list);
    // The channels of `up` first, as in the whole layer: sums in the same order.
    const TensorId up =
        addConvPass(graph, "out up", forwardPass(net.last(), false, {}, list), f[0], weights, y);
    weights.weightOffset += net.upChannels(0) * net.last().kernel.h * net.last().kernel.w;
    return input.convolve("out", forwardPass(net.last(), weights.hasBias, {}, list), true, weights,
                          up);
}

void unetBackward(RenderGraph& graph, const UNetDesc& net, ParameterIds& parameters,
                  const UNetValues& v, const TensorId& dY)
{
    // d[l]: gradients before the activation (dZ) of both parts of a level. `up` has one reader, so
    // it is finished when that reader's data gradient is. So is the coarsest skip; any other gets a
    // second part from the encoder below it, and only then goes back through the activation.
    const std::vector<TensorId>& f = v.levels;
    std::vector<TensorId> d;
    for (std::uint32_t l = 0; l <= net.levels(); ++l) {
        TensorDesc desc = f[l].desc;
        if (l == 0 && net.head == 0) // x needs no gradient
            desc.c = net.upChannels(0);
        d.push_back(createTensor(graph, layerName("d level ", l), desc));
    }
    const auto through = [&](const TensorId& activated) {
        return BackwardEpilogue{.activated = activated, .slope = net.slope};
    };
    // From the layer that reads both parts of level l.
    const auto intoLevel = [&](std::uint32_t l, const std::string& name, const auto& backwardInput,
                               const auto& desc, const TensorId& dZ) {
        const LayerWeights w = parameters.weights(name);
        if (l == net.levels()) {
            written(d[l], backwardInput(graph, name + " dX", desc, dZ, w, d[l], through(f[l])));
            return;
        }
        written(d[l], backwardInput(graph, name + " dUp", desc, dZ, w, upOf(net, d, l),
                                    through(upOf(net, f, l))));
        if (l > 0 || net.head > 0)
            written(d[l], backwardInput(graph, name + " dSkip", desc, dZ, w, skipOf(net, d, l),
                                        {.firstInput = net.upChannels(l)}));
    };

    parameters.gradient =
        conv2dBackwardWeight(graph, "out dW", net.last(), f[0], dY, parameters.gradients("out"));
    intoLevel(0, "out", conv2dBackwardInput, net.last(), dY);
    for (std::uint32_t l = 0; l < net.levels(); ++l) {
        const std::string name = layerName("dec", l);
        const TensorId dUp = upOf(net, d, l);
        parameters.gradient = convTranspose2dBackwardWeight(
            graph, name + " dW", net.decoder(l), f[l + 1], dUp, parameters.gradients(name));
        intoLevel(l + 1, name, convTranspose2dBackwardInput, net.decoder(l), dUp);
    }
    for (std::uint32_t l = net.levels(); l > 0; --l) {
        const std::string name = layerName("enc", l);
        const TensorId dSkip = skipOf(net, d, l);
        parameters.gradient =
            conv2dBackwardWeight(graph, name + " dW", net.encoder(l), skipOf(net, f, l - 1), dSkip,
                                 parameters.gradients(name));
        if (l == 1 && net.head == 0)
            continue;
        BackwardEpilogue secondPart = through(skipOf(net, f, l - 1));
        secondPart.accumulate = true;
        written(d[l - 1],
                conv2dBackwardInput(graph, name + " dX", net.encoder(l), dSkip,
                                    parameters.weights(name), skipOf(net, d, l - 1), secondPart));
    }
    if (net.head > 0)
        parameters.gradient = conv2dBackwardWeight(graph, "enc0 dW", net.encoder(0), v.x,
                                                   skipOf(net, d, 0), parameters.gradients("enc0"));
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
