// The spherical-gaussian mixture of `strandlight bench kernels`: one training step's forward and
// backward pass over the mixture of 64x64 texels x 16x16 directions x 8 lobes.
#include <cmath>

#include "compute_nn/reference/sg_mixture.hpp"
#include "compute_nn/sg_mixture.hpp"
#include "samples/strandlight/bench_kernels.hpp"

namespace strandlight::cli {

namespace {

// Of one (texel, direction, lobe) besides the exponential: chord 3, its square 5, times falloff 1;
// then amplitudes 6 forward, and backward weighted gradient 3, with amplitude 5, d amplitude 3, d
// sharpness 3, d axis 6.
constexpr double kForwardFlops = 15.0;
constexpr double kBackwardFlops = 29.0;

std::vector<float> unitVectors(std::uint32_t count, std::uint32_t seed)
{
    std::vector<float> v = randomValues(count * std::size_t(3), seed);
    for (std::uint32_t i = 0; i < count; ++i) {
        const double length = std::hypot(double(v[3 * i]), v[3 * i + 1], v[3 * i + 2]);
        for (std::uint32_t k = 0; k < 3; ++k)
            v[3 * i + k] = float(v[3 * i + k] / length);
    }
    return v;
}

// Radiance and gradient of one image, by the twins in double: appends what was got and what is
// right.
struct Comparison
{
    std::vector<double> radiance, expectedRadiance, dRaw, expectedDRaw;

    void add(const SgMixtureDesc& desc, std::uint32_t image, std::span<const float> rawOfAll,
             std::span<const float> directions, std::span<const float> dOutOfAll,
             std::span<const float> gotRadiance, std::span<const float> gotDRaw)
    {
        const std::size_t d = desc.directions, values = desc.lobes * std::size_t(7);
        const auto rawOf = rawOfAll.subspan(image * values, values);
        const std::vector<double> raw(rawOf.begin(), rawOf.end());
        std::vector<double> gradient(values, 0.0);
        for (std::size_t i = 0; i < d; ++i) {
            const double along[3] = {directions[3 * i], directions[3 * i + 1],
                                     directions[3 * i + 2]};
            double rgb[3] = {}, dRgb[3];
            for (std::size_t c = 0; c < 3; ++c)
                dRgb[c] = dOutOfAll[(image * 3 + c) * d + i];
            reference::sgMixture<double>(raw, along, rgb);
            reference::sgMixtureBackward<double>(raw, along, dRgb, gradient);
            for (std::size_t c = 0; c < 3; ++c) {
                radiance.push_back(gotRadiance[(image * 3 + c) * d + i]);
                expectedRadiance.push_back(rgb[c]);
            }
        }
        for (std::size_t k = 0; k < values; ++k) {
            dRaw.push_back(gotDRaw[image * values + k]);
            expectedDRaw.push_back(gradient[k]);
        }
    }
};

KernelMeasurement measureMixture(Context& context, const BenchOptions& o, Ceilings& ceilings)
{
    const SgMixtureDesc desc{
        .images = o.quick ? 64u : 64u * 64u, .lobes = 8, .directions = 16 * 16};
    const TensorDesc out{desc.images, 3, 16, 16};
    const std::vector<float> raw = randomValues(desc.raw().elements(), 7);
    const std::vector<float> along = unitVectors(desc.directions, 8);
    const std::vector<float> dOut = randomValues(out.elements(), 9);
    RenderGraph graph(context);
    const TensorId rawId = uploadTensor(graph, "raw", desc.raw(), raw);
    const BufferId directions = graph.uploadBuffer("directions", std::span(along));
    const TensorId lobes = addSgDecodePass(graph, desc, rawId);
    const TensorId radiance =
        sgMixtureForward(graph, desc, lobes, directions, createTensor(graph, "radiance", out));
    const TensorId dRaw =
        sgMixtureBackward(graph, desc, rawId, directions, uploadTensor(graph, "dOut", out, dOut),
                          createTensor(graph, "d raw", desc.raw()));
    graph.output(radiance.buffer);
    graph.output(dRaw.buffer);

    KernelMeasurement m;
    const double evaluations = double(desc.images) * desc.directions * desc.lobes;
    m.flops = evaluations * (kForwardFlops + kBackwardFlops + 2.0 * ceilings.flopsOfExp);
    m.more["exp_counted_as_flops"] = ceilings.flopsOfExp;
    timeBeside(m, ceilings, graph, {}, roundsOf(o));
    const auto gotRadiance = graph.read<float>(radiance.buffer),
               gotDRaw = graph.read<float>(dRaw.buffer);
    Comparison comparison;
    for (std::uint32_t image = 0; image < desc.images; image += desc.images / 16 - 1)
        comparison.add(desc, image, raw, along, dOut, gotRadiance, gotDRaw);
    m.error = std::max(normError(comparison.radiance, comparison.expectedRadiance),
                       normError(comparison.dRaw, comparison.expectedDRaw));
    return m;
}

} // namespace

void addSgBenchCases(std::vector<KernelCase>& cases)
{
    cases.push_back({"SG mixture step 64x64 texels, 16x16 directions, 8 lobes", measureMixture});
}

} // namespace strandlight::cli
