#include "compute_nn/reference/networks.hpp"

#include <array>
#include <cmath>

#include "compute_nn/reference/activation.hpp"
#include "compute_nn/reference/conv2d.hpp"
#include "compute_nn/reference/loss.hpp"
#include "compute_nn/reference/sg_mixture.hpp"

namespace strandlight::reference {

namespace {

// A tensor and its gradient.
template <class T> struct Node
{
    explicit Node(const TensorDesc& d) : desc(d), x(d.elements()), dX(d.elements(), T(0)) {}
    TensorDesc desc;
    std::vector<T> x;
    std::vector<T> dX;
};

// A network's parameters and gradients by name.
template <class T> struct Weights
{
    const ParameterLayout& layout;
    std::span<const T> values;
    std::vector<T>& gradient;

    std::span<const T> value(const std::string& name) const
    {
        const ParameterSlice& slice = layout.slice(name);
        return values.subspan(slice.offset, slice.count);
    }
    std::span<T> grad(const std::string& name) const
    {
        const ParameterSlice& slice = layout.slice(name);
        return std::span<T>(gradient).subspan(slice.offset, slice.count);
    }
};

template <class T>
void forward(const Weights<T>& w, const std::string& name, const Conv2dDesc& d, const Node<T>& x,
             const Activation& a, Node<T>& y)
{
    conv2d<T>(d, x.desc, x.x, w.value(name + ".weight"), w.value(name + ".bias"), y.x);
    activationForward<T>(a, y.x, y.x);
}

template <class T>
void forward(const Weights<T>& w, const std::string& name, const ConvTranspose2dDesc& d,
             const Node<T>& x, const Activation& a, Node<T>& y)
{
    convTranspose2d<T>(d, x.desc, x.x, w.value(name + ".weight"), w.value(name + ".bias"), y.x);
    activationForward<T>(a, y.x, y.x);
}

template <class T> std::vector<T> throughActivation(const Activation& a, const Node<T>& y)
{
    std::vector<T> dZ(y.x.size(), T(0));
    activationBackward<T>(a, y.x, y.dX, dZ);
    return dZ;
}

template <class T>
void backward(const Weights<T>& w, const std::string& name, const Conv2dDesc& d, Node<T>& x,
              const Activation& a, const Node<T>& y)
{
    const std::vector<T> dZ = throughActivation(a, y);
    conv2dBackward<T>(d, x.desc, x.x, w.value(name + ".weight"), dZ, x.dX, w.grad(name + ".weight"),
                      w.grad(name + ".bias"));
}

template <class T>
void backward(const Weights<T>& w, const std::string& name, const ConvTranspose2dDesc& d,
              Node<T>& x, const Activation& a, const Node<T>& y)
{
    const std::vector<T> dZ = throughActivation(a, y);
    convTranspose2dBackward<T>(d, x.desc, x.x, w.value(name + ".weight"), dZ, x.dX,
                               w.grad(name + ".weight"), w.grad(name + ".bias"));
}

// Channels of `up`, then those of `skip`.
template <class T> Node<T> concat(const Node<T>& up, const Node<T>& skip)
{
    Node<T> both({up.desc.n, up.desc.c + skip.desc.c, up.desc.h, up.desc.w});
    const std::size_t a = std::size_t(up.desc.c) * up.desc.pixels();
    const std::size_t b = std::size_t(skip.desc.c) * skip.desc.pixels();
    for (std::size_t i = 0; i < both.x.size(); ++i) {
        const std::size_t n = i / (a + b), r = i % (a + b);
        both.x[i] = r < a ? up.x[n * a + r] : skip.x[n * b + r - a];
    }
    return both;
}

template <class T> void concatBackward(const Node<T>& both, Node<T>& up, Node<T>& skip)
{
    const std::size_t a = std::size_t(up.desc.c) * up.desc.pixels();
    const std::size_t b = std::size_t(skip.desc.c) * skip.desc.pixels();
    for (std::size_t i = 0; i < both.x.size(); ++i) {
        const std::size_t n = i / (a + b), r = i % (a + b);
        (r < a ? up.dX[n * a + r] : skip.dX[n * b + r - a]) += both.dX[i];
    }
}

} // namespace

template <class T>
NetworkResult<T> unet(const UNetDesc& net, std::span<const T> parameters, const TensorDesc& xDesc,
                      std::span<const T> x, std::span<const T> target)
{
    net.check(xDesc);
    const ParameterLayout layout = net.parameters();
    NetworkResult<T> result;
    result.gradient.assign(layout.count(), T(0));
    const Weights<T> w{layout, parameters, result.gradient};
    const Activation leaky = Activation::leakyRelu(net.slope);

    const std::uint32_t bottom = net.levels();
    const auto enc = [](std::uint32_t l) { return "enc" + std::to_string(l); };
    const auto dec = [](std::uint32_t l) { return "dec" + std::to_string(l); };
    Node<T> image(xDesc);
    image.x.assign(x.begin(), x.end());

    // Down; without a head the image is the first skip.
    std::vector<Node<T>> skip{image};
    if (net.head > 0) {
        skip[0] = Node<T>(net.encoder(0).output(xDesc));
        forward(w, enc(0), net.encoder(0), image, leaky, skip[0]);
    }
    for (std::uint32_t l = 1; l <= bottom; ++l) {
        skip.emplace_back(net.encoder(l).output(skip[l - 1].desc));
        forward(w, enc(l), net.encoder(l), skip[l - 1], leaky, skip[l]);
    }
    // Up; both[l] is [up, skip], of the coarsest level the skip alone.
    std::vector<Node<T>> both(skip), up(skip);
    for (std::uint32_t l = bottom; l-- > 0;) {
        up[l] = Node<T>(net.decoder(l).output(both[l + 1].desc));
        forward(w, dec(l), net.decoder(l), both[l + 1], leaky, up[l]);
        both[l] = concat(up[l], skip[l]);
    }
    Node<T> y(net.last().output(both[0].desc));
    forward(w, "out", net.last(), both[0], Activation::none(), y);
    result.output = y.x;

    result.loss = loss<T>(LossKind::MeanSquare, y.x, target, {}, 1, y.dX);
    backward(w, "out", net.last(), both[0], Activation::none(), y);
    for (std::uint32_t l = 0; l < bottom; ++l) {
        concatBackward(both[l], up[l], skip[l]);
        backward(w, dec(l), net.decoder(l), both[l + 1], leaky, up[l]);
    }
    skip[bottom].dX = both[bottom].dX;
    for (std::uint32_t l = bottom; l > 0; --l)
        backward(w, enc(l), net.encoder(l), skip[l - 1], leaky, skip[l]);
    if (net.head > 0)
        backward(w, enc(0), net.encoder(0), image, leaky, skip[0]);
    return result;
}

template <class T>
NetworkResult<T> encoder(const EncoderDesc& net, std::span<const T> parameters,
                         std::uint32_t images, std::span<const T> image,
                         std::span<const T> directions, std::span<const T> weights, LossKind kind)
{
    const ParameterLayout layout = net.parameters();
    NetworkResult<T> result;
    result.gradient.assign(layout.count(), T(0));
    const Weights<T> w{layout, parameters, result.gradient};
    const Activation leaky = Activation::leakyRelu(net.slope);

    std::vector<Node<T>> nodes{Node<T>(net.input(images))};
    for (std::size_t i = 0; i < image.size(); ++i)
        nodes[0].x[i] = std::log1p(image[i]);
    for (std::uint32_t i = 0; i < 4; ++i) {
        nodes.emplace_back(net.layer(i).output(nodes[i].desc));
        forward(w, "conv" + std::to_string(i), net.layer(i), nodes[i], leaky, nodes[i + 1]);
    }
    Node<T> raw({images, net.lobes * 7, 1, 1});
    forward(w, "head", net.head(), nodes[4], Activation::none(), raw);
    result.output = raw.x;

    // Mixture in every direction of every image, planar like the image: [N,3,S S].
    const std::size_t count = directions.size() / 3;
    const std::size_t perImage = std::size_t(net.lobes) * 7;
    std::vector<T> radiance(image.size(), T(0)), dRadiance(image.size(), T(0));
    for (std::size_t n = 0; n < images; ++n)
        for (std::size_t d = 0; d < count; ++d) {
            std::array<T, 3> rgb{};
            sgMixture<T>(std::span<const T>(raw.x).subspan(n * perImage, perImage),
                         directions.subspan(d * 3, 3), rgb);
            for (std::size_t c = 0; c < 3; ++c)
                radiance[(n * 3 + c) * count + d] = rgb[c];
        }
    result.loss = loss<T>(kind, radiance, image, weights, 1, dRadiance);
    for (std::size_t n = 0; n < images; ++n)
        for (std::size_t d = 0; d < count; ++d) {
            std::array<T, 3> dRgb{};
            for (std::size_t c = 0; c < 3; ++c)
                dRgb[c] = dRadiance[(n * 3 + c) * count + d];
            sgMixtureBackward<T>(std::span<const T>(raw.x).subspan(n * perImage, perImage),
                                 directions.subspan(d * 3, 3), dRgb,
                                 std::span<T>(raw.dX).subspan(n * perImage, perImage));
        }
    backward(w, "head", net.head(), nodes[4], Activation::none(), raw);
    for (std::uint32_t i = 4; i-- > 0;)
        backward(w, "conv" + std::to_string(i), net.layer(i), nodes[i], leaky, nodes[i + 1]);
    return result;
}

template NetworkResult<float> unet(const UNetDesc&, std::span<const float>, const TensorDesc&,
                                   std::span<const float>, std::span<const float>);
template NetworkResult<double> unet(const UNetDesc&, std::span<const double>, const TensorDesc&,
                                    std::span<const double>, std::span<const double>);
template NetworkResult<float> encoder(const EncoderDesc&, std::span<const float>, std::uint32_t,
                                      std::span<const float>, std::span<const float>,
                                      std::span<const float>, LossKind);
template NetworkResult<double> encoder(const EncoderDesc&, std::span<const double>, std::uint32_t,
                                       std::span<const double>, std::span<const double>,
                                       std::span<const double>, LossKind);

} // namespace strandlight::reference
