// The SG decoder and mixture under stress, through their public passes.
#include <array>
#include <cmath>

#include "compute_nn/reference/sg_mixture.hpp"
#include "compute_nn/sg_mixture.hpp"
#include "passes/stress/inputs.hpp"
#include "passes/stress/kernel_inputs.hpp"
#include "passes/stress/tally.hpp"

namespace strandlight {

namespace {

std::vector<float> directionsOf(std::uint32_t seed, std::uint32_t count)
{
    std::vector<float> list;
    for (std::uint32_t d = 0; d < count; ++d) {
        const glm::vec3 v = StressRandom(seed, d).direction();
        list.insert(list.end(), {v.x, v.y, v.z});
    }
    return list;
}

// Mixtures of one lobe each, from every combination of four special raw values: what a decoder must
// survive.
void stressDecode(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    const SgMixtureDesc desc{
        .images = kSpecials * kSpecials * kSpecials * kSpecials, .lobes = 1, .directions = 4};
    const std::vector<float> along = directionsOf(s.seed + 90, desc.directions);
    std::vector<float> raw;
    for (std::uint32_t i = 0; i < desc.images; ++i)
        raw.insert(raw.end(), {specialValue(i, 0), 0.25f, -specialValue(i, 1), specialValue(i, 2),
                               specialValue(i, 3), -specialValue(i, 3), 0.5f});
    RenderGraph graph(context);
    const TensorId lobes =
        addSgDecodePass(graph, desc, uploadTensor(graph, "raw", desc.raw(), raw));
    const TensorId radiance =
        sgMixtureForward(graph, desc, lobes, graph.uploadBuffer("along", std::span(along)),
                         createTensor(graph, "radiance", {desc.images, 3, 1, desc.directions}));
    graph.output(radiance.buffer);
    graph.run();
    const std::vector<float> got = graph.read<float>(radiance.buffer);

    Tally value("sg decoder and mixture, special values, device", 2e-5, "amplitude");
    for (std::uint32_t i = 0; i < desc.images; ++i) {
        const std::vector<double> one(raw.begin() + i * 7, raw.begin() + i * 7 + 7);
        const reference::Lobe<double> lobe = reference::decodeLobe<double>(one);
        const bool finite = std::isfinite(one[0] + one[2] + one[3] + one[4]);
        for (std::uint32_t d = 0; d < desc.directions; ++d) {
            std::array<double, 3> rgb{};
            const std::vector<double> direction(along.begin() + d * 3, along.begin() + d * 3 + 3);
            reference::sgMixture<double>(one, direction, rgb);
            for (std::uint32_t c = 0; c < 3; ++c) {
                const auto text = [&] {
                    return "combination " + std::to_string(i) + ", direction " + std::to_string(d);
                };
                const double v = double(got[(i * 3 + c) * desc.directions + d]);
                if (finite)
                    value.compare(v, rgb[c], std::max(lobe.amplitude[c], 1e-30), text);
                else // the optimiser's checks see the parameters and the gradient
                    value.refuse();
            }
        }
    }
    rows.push_back(value.row());
}

void stressMixtureShapes(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    Tally forward("sg mixture, forward, device", 2e-5, "sum of amplitudes");
    Tally backward("sg mixture, gradients, device", 1e-4, "norm of the lobe's gradient");
    for (std::uint32_t i = 0; i < s.shapes; ++i) {
        StressRandom r(s.seed + 91, i);
        const SgMixtureDesc desc{
            .images = r.integer(1, 5), .lobes = r.integer(1, 24), .directions = r.integer(1, 300)};
        const std::vector<float> along = directionsOf(s.seed + 92 + i, desc.directions);
        const TensorDesc out{desc.images, 3, 1, desc.directions};
        const std::vector<float> raw = stressTensor(desc.raw().elements(), s.seed + 93 + i, 4.0f);
        const std::vector<float> dOut = stressTensor(out.elements(), s.seed + 94 + i);
        RenderGraph graph(context);
        const TensorId input = uploadTensor(graph, "raw", desc.raw(), raw);
        const BufferId list = graph.uploadBuffer("along", std::span(along));
        const TensorId radiance = sgMixtureForward(graph, desc, addSgDecodePass(graph, desc, input),
                                                   list, createTensor(graph, "radiance", out));
        const TensorId dRaw =
            sgMixtureBackward(graph, desc, input, list, uploadTensor(graph, "d", out, dOut),
                              createTensor(graph, "dRaw", desc.raw()));
        graph.output(radiance.buffer);
        graph.output(dRaw.buffer);
        graph.run();
        const std::vector<float> got = graph.read<float>(radiance.buffer),
                                 gotD = graph.read<float>(dRaw.buffer);
        const std::vector<double> all = toDouble(raw), list64 = toDouble(along);
        const std::size_t floats = std::size_t(desc.lobes) * 7;
        const auto text = [&] {
            return std::to_string(desc.images) + " images, " + std::to_string(desc.lobes) +
                   " lobes, " + std::to_string(desc.directions) + " directions, shape " +
                   std::to_string(i);
        };
        for (std::uint32_t n = 0; n < desc.images; ++n) {
            const auto lobes = std::span(all).subspan(n * floats, floats);
            std::vector<double> dLobes(floats, 0.0);
            double amplitudes = 0.0;
            for (std::uint32_t l = 0; l < desc.lobes; ++l)
                amplitudes += reference::softplus(lobes[l * 7 + 4]) +
                              reference::softplus(lobes[l * 7 + 5]) +
                              reference::softplus(lobes[l * 7 + 6]);
            for (std::uint32_t d = 0; d < desc.directions; ++d) {
                std::array<double, 3> rgb{}, dRgb{};
                const auto direction = std::span(list64).subspan(d * 3, 3);
                reference::sgMixture<double>(lobes, direction, rgb);
                for (std::uint32_t c = 0; c < 3; ++c) {
                    const std::size_t at = (std::size_t(n) * 3 + c) * desc.directions + d;
                    dRgb[c] = double(dOut[at]);
                    forward.compare(double(got[at]), rgb[c], amplitudes, text);
                }
                reference::sgMixtureBackward<double>(lobes, direction, dRgb, dLobes);
            }
            for (std::uint32_t l = 0; l < desc.lobes; ++l) {
                double norm = 0.0;
                for (std::uint32_t k = 0; k < 7; ++k)
                    norm += dLobes[l * 7 + k] * dLobes[l * 7 + k];
                for (std::uint32_t k = 0; k < 7; ++k)
                    backward.compare(double(gotD[n * floats + l * 7 + k]), dLobes[l * 7 + k],
                                     std::sqrt(norm) + 1e-6, text);
            }
        }
    }
    rows.push_back(forward.row());
    rows.push_back(backward.row());
}

} // namespace

std::vector<StressRow> stressMixtures(Context& context, const StressSettings& settings)
{
    std::vector<StressRow> rows;
    stressDecode(context, settings, rows);
    stressMixtureShapes(context, settings, rows);
    return rows;
}

} // namespace strandlight
