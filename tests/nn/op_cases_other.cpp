#include "tests/nn/op_cases.hpp"

#include <cmath>

#include "compute_nn/activation.hpp"
#include "compute_nn/kernel_filter.hpp"
#include "compute_nn/loss.hpp"
#include "compute_nn/reference/activation.hpp"
#include "compute_nn/reference/kernel_filter.hpp"
#include "compute_nn/reference/loss.hpp"
#include "compute_nn/reference/sg_mixture.hpp"
#include "compute_nn/sg_mixture.hpp"
#include "tests/nn/compare.hpp"

namespace strandlight::test {

namespace {

void addActivation(std::vector<OpCase>& cases, const Activation& a,
                   const TensorDesc& desc = {3, 5, 7, 11})
{
    // Beyond +-88 the naive formulas overflow; the last values probe the twins' own extremes.
    const auto values = [desc] {
        std::vector<float> x = randomValues<float>(desc.elements(), 30, -20.0f, 20.0f);
        const float extremes[] = {0.0f, 1e-8f, -1e-8f, 1.0f, 100.0f, -100.0f, 1e4f, -1e4f, 1e-20f};
        std::copy(std::begin(extremes), std::end(extremes), x.begin());
        return x;
    };
    cases.push_back(
        {"activation " + std::to_string(std::uint32_t(a.kind)) + " " + shapeText(desc),
         [=](Context& context) {
             RenderGraph graph(context);
             const TensorId x = uploadTensor(graph, "x", desc, values());
             const TensorId dY =
                 uploadTensor(graph, "dY", desc, randomValues<float>(desc.elements(), 31));
             TensorId dX =
                 uploadTensor(graph, "dX", desc, randomValues<float>(desc.elements(), 32));
             const TensorId y = activationForward(graph, "f", a, x, createTensor(graph, "y", desc));
             dX = activationBackward(graph, "b", a, y, dY, dX);
             graph.output(y.buffer);
             graph.output(dX.buffer);
             graph.execute();
             return std::vector<Output>{{"y", graph.read<float>(y.buffer)},
                                        {"dX", graph.read<float>(dX.buffer)}};
         },
         [=] {
             const std::vector<double> x = convert<double>(values());
             std::vector<double> y(x.size()), dX = randomValues<double>(x.size(), 32);
             reference::activationForward<double>(a, x, y);
             reference::activationBackward<double>(a, y, randomValues<double>(x.size(), 31), dX);
             return std::vector<ExpectedOutput>{{"y", y}, {"dX", dX}};
         }});
}

void addLoss(std::vector<OpCase>& cases, LossKind kind, const TensorDesc& desc, bool weighted)
{
    const std::size_t count = desc.elements();
    const auto values = [count](std::uint32_t seed) {
        std::vector<float> v = randomValues<float>(count, seed, 0.0f, 5.0f);
        for (std::size_t i = 0; i < count; i += 5) // black and bright elements among the others
            v[i] = i % 2 ? 0.0f : v[i] * 1000.0f;
        return v;
    };
    cases.push_back(
        {"loss " + std::to_string(std::uint32_t(kind)) + " " + shapeText(desc),
         [=](Context& context) {
             RenderGraph graph(context);
             const std::vector<float> w = randomValues<float>(desc.w, 42, 0.1f, 2.0f);
             std::optional<LossWeights> weights;
             if (weighted)
                 weights = LossWeights{graph.uploadBuffer("weights", std::span(w)), desc.w, 2};
             const LossResult loss =
                 addLossPass(graph, "loss", kind, uploadTensor(graph, "p", desc, values(40)),
                             uploadTensor(graph, "t", desc, values(41)), weights);
             graph.output(loss.value);
             graph.output(loss.gradient.buffer);
             graph.execute();
             return std::vector<Output>{{"value", graph.read<float>(loss.value)},
                                        {"gradient", graph.read<float>(loss.gradient.buffer)}};
         },
         [=] {
             const std::vector<double> w =
                 weighted ? randomValues<double>(desc.w, 42, 0.1f, 2.0f) : std::vector<double>();
             std::vector<double> gradient(count, 0.0);
             const double value = reference::loss<double>(
                 kind, convert<double>(values(40)), convert<double>(values(41)), w, 2, gradient);
             return std::vector<ExpectedOutput>{{"value", {value}}, {"gradient", gradient}};
         }});
}

std::vector<float> unitVectors(std::size_t count, std::uint32_t seed)
{
    std::vector<float> v = randomValues<float>(count * 3, seed);
    for (std::size_t i = 0; i < count; ++i) {
        const double length = std::hypot(double(v[3 * i]), v[3 * i + 1], v[3 * i + 2]);
        for (std::size_t k = 0; k < 3; ++k)
            v[3 * i + k] = float(v[3 * i + k] / length);
    }
    return v;
}

void addMixture(std::vector<OpCase>& cases, const SgMixtureDesc& desc)
{
    const std::size_t d = desc.directions;
    const std::size_t lists = desc.sharedDirections ? 1 : desc.images;
    const TensorDesc out = desc.planar ? TensorDesc{desc.images, 3, 1, desc.directions}
                                       : TensorDesc{desc.images, desc.directions, 1, 3};
    cases.push_back(
        {"sg_mixture " + shapeText(desc.raw()) + " " + std::to_string(d) + " directions",
         [=](Context& context) {
             RenderGraph graph(context);
             const TensorId raw = uploadTensor(
                 graph, "raw", desc.raw(), randomValues<float>(desc.raw().elements(), 50, -3, 3));
             const std::vector<float> along = unitVectors(lists * d, 51);
             const BufferId directions = graph.uploadBuffer("directions", std::span(along));
             const TensorId dOut =
                 uploadTensor(graph, "dOut", out, randomValues<float>(out.elements(), 52));
             const TensorId lobes = addSgDecodePass(graph, desc, raw);
             const TensorId radiance = sgMixtureForward(graph, desc, lobes, directions,
                                                        createTensor(graph, "radiance", out));
             const TensorId dRaw = sgMixtureBackward(graph, desc, raw, directions, dOut,
                                                     createTensor(graph, "dRaw", desc.raw()));
             graph.output(radiance.buffer);
             graph.output(dRaw.buffer);
             graph.execute();
             return std::vector<Output>{{"radiance", graph.read<float>(radiance.buffer)},
                                        {"dRaw", graph.read<float>(dRaw.buffer)}};
         },
         [=] {
             const std::vector<double> raw = randomValues<double>(desc.raw().elements(), 50, -3, 3);
             const std::vector<double> along = convert<double>(unitVectors(lists * d, 51));
             const std::vector<double> dOut = randomValues<double>(out.elements(), 52);
             std::vector<double> radiance(out.elements()), dRaw(raw.size(), 0.0);
             const std::size_t perImage = desc.lobes * 7;
             for (std::size_t n = 0; n < desc.images; ++n)
                 for (std::size_t i = 0; i < d; ++i) {
                     const auto at = [&](std::size_t c) {
                         return desc.planar ? (n * 3 + c) * d + i : (n * d + i) * 3 + c;
                     };
                     std::vector<double> rgb(3, 0.0),
                         dRgb = {dOut[at(0)], dOut[at(1)], dOut[at(2)]};
                     const auto mixture = std::span(raw).subspan(n * perImage, perImage);
                     const auto direction =
                         std::span(along).subspan(((desc.sharedDirections ? 0 : n * d) + i) * 3, 3);
                     reference::sgMixture<double>(mixture, direction, rgb);
                     reference::sgMixtureBackward<double>(
                         mixture, direction, dRgb, std::span(dRaw).subspan(n * perImage, perImage));
                     for (std::size_t c = 0; c < 3; ++c)
                         radiance[at(c)] = rgb[c];
                 }
             return std::vector<ExpectedOutput>{{"radiance", radiance}, {"dRaw", dRaw}};
         }});
}

void addKernelFilter(std::vector<OpCase>& cases, const TensorDesc& image, float spread)
{
    TensorDesc taps = image;
    taps.c = gpu::kFilterTaps;
    // Logits lie between other channels, as they do in a network's output.
    const TensorDesc wide{taps.n, taps.c + 3, taps.h, taps.w};
    const auto logits = [=] {
        const std::vector<float> all = randomValues<float>(wide.elements(), 60, -spread, spread);
        std::vector<double> part;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (i / wide.pixels() % wide.c >= 3)
                part.push_back(all[i]);
        return part;
    };
    cases.push_back(
        {"kernel_filter " + shapeText(image),
         [=](Context& context) {
             RenderGraph graph(context);
             const TensorId out =
                 uploadTensor(graph, "network output", wide,
                              randomValues<float>(wide.elements(), 60, -spread, spread));
             const TensorId kernel = channelRange(out, 3, taps.c);
             const TensorId x =
                 uploadTensor(graph, "image", image, randomValues<float>(image.elements(), 61));
             const TensorId dY =
                 uploadTensor(graph, "dY", image, randomValues<float>(image.elements(), 62));
             const TensorId y =
                 kernelFilterForward(graph, "f", kernel, x, createTensor(graph, "y", image));
             const TensorId dLogits = kernelFilterBackward(graph, "b", kernel, x, dY,
                                                           createTensor(graph, "dLogits", taps));
             graph.output(y.buffer);
             graph.output(dLogits.buffer);
             graph.execute();
             return std::vector<Output>{{"y", graph.read<float>(y.buffer)},
                                        {"dLogits", graph.read<float>(dLogits.buffer)}};
         },
         [=] {
             const std::vector<double> x = randomValues<double>(image.elements(), 61);
             std::vector<double> y(image.elements()), dLogits(taps.elements());
             reference::kernelFilter<double>(image, logits(), x, y);
             reference::kernelFilterBackward<double>(
                 image, logits(), x, randomValues<double>(image.elements(), 62), dLogits);
             return std::vector<ExpectedOutput>{{"y", y}, {"dLogits", dLogits}};
         }});
}

} // namespace

void addOtherCases(std::vector<OpCase>& cases)
{
    for (const Activation& a : {Activation{ActivationKind::None}, Activation{ActivationKind::Relu},
                                Activation::leakyRelu(0.1f), Activation{ActivationKind::Softplus},
                                Activation{ActivationKind::Sigmoid}})
        addActivation(cases, a);
    // More groups than one axis of a dispatch takes.
    addActivation(cases, Activation::none(), {1, 33, 320, 256});
    for (LossKind kind : {LossKind::MeanSquare, LossKind::Relative, LossKind::Log1p}) {
        addLoss(cases, kind, {1, 1, 1, 1}, false);
        addLoss(cases, kind, {1, 3, 13, 5}, true);
        addLoss(cases, kind, {2, 3, 64, 67}, true);
    }
    // Two images: of the first one the only weight is 1e-35, which the kernels take for zero.
    addMixture(cases, {.images = 2, .lobes = 1, .directions = 1});
    addMixture(cases, {.images = 7, .lobes = 8, .directions = 256});
    addMixture(
        cases,
        {.images = 3, .lobes = 5, .directions = 37, .sharedDirections = false, .planar = false});
    addMixture(cases, {.images = 2, .lobes = 3, .directions = 33, .sharedDirections = false});
    // As many directions as one invocation may loop over.
    addMixture(cases, {.images = 1, .lobes = 2, .directions = 32768});
    addKernelFilter(cases, {1, 4, 1, 1}, 3.0f); // one tap alone is inside
    addKernelFilter(cases, {2, 4, 13, 7}, 3.0f);
    addKernelFilter(cases, {1, 4, 9, 33}, 100.0f); // exponentials that would overflow
}

} // namespace strandlight::test
