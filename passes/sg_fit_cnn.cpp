#include "passes/sg_fit_cnn.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "compute_nn/encoder.hpp"
#include "compute_nn/sg_mixture.hpp"
#include "engine/base/assert.hpp"
#include "engine/base/progress.hpp"
#include "engine/graph/render_graph.hpp"
#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/rng.h"
#include "shaders/shared/sg.h"
#include "shaders/shared/sg_fit_types.h"

namespace strandlight {
namespace {

constexpr std::uint32_t kTexelsPerStep = 512;
// Halves every third of the training. On the synthetic room, 16 x 16 texels, 300 steps: radiance
// error 0.21 with 6e-3 and squares, 0.34 with 2e-3, 0.41 with squares of ln(1 + radiance).
constexpr double kLearningRate = 6.0e-3;
constexpr std::uint32_t kRawComponents = 7;
// Of the head's usual initial weights: the bias decides at first, the image later.
constexpr float kHeadWeightShare = 0.1f;

// The encoder sees radiance over the scene's mean, so that its ln(1 + x) works where the light is.
double meanScale(const FitProblem& problem)
{
    double sum = 0.0;
    std::uint64_t count = 0;
    for (const float scale : problem.scales) {
        if (scale > 0.0f) {
            sum += double(scale);
            ++count;
        }
    }
    return count > 0 ? sum / double(count) : 1.0;
}

// Images [N, 3, S S] of some texels, over the mean.
std::vector<float> gatherImages(const FitProblem& problem, std::span<const std::uint32_t> texels,
                                float perMean)
{
    const std::size_t directions = problem.directionCount();
    std::vector<float> values(texels.size() * 3 * directions);
    for (std::size_t d = 0; d < directions; ++d) {
        for (std::size_t n = 0; n < texels.size(); ++n) {
            const glm::vec3 radiance =
                gpu::unpackRgb9e5(problem.images[d * problem.texelCount() + texels[n]]);
            for (int c = 0; c < 3; ++c)
                values[(n * 3 + std::size_t(c)) * directions + d] = radiance[c] * perMean;
        }
    }
    return values;
}

// The texels with images in an order of their own for every epoch.
std::vector<std::uint32_t> shuffledTexels(const FitProblem& problem, std::uint32_t epoch,
                                          std::uint32_t seed)
{
    std::vector<std::uint32_t> texels;
    for (std::uint32_t t = 0; t < problem.texelCount(); ++t)
        if (problem.scales[t] > 0.0f)
            texels.push_back(t);
    const std::uint32_t key = gpu::hashPcg(epoch ^ gpu::hashPcg(seed));
    std::sort(texels.begin(), texels.end(), [&](std::uint32_t a, std::uint32_t b) {
        const std::uint32_t ha = gpu::hashPcg(a ^ key), hb = gpu::hashPcg(b ^ key);
        return ha != hb ? ha < hb : a < b;
    });
    return texels;
}

// The head's bias says which lobes an average image has: the common start of the direct fit.
// Without it all axes start as noise of length zero, and lobes change their identity from texel to
// texel.
void startFromCommonLobes(const FitProblem& problem, FitStart start, Parameters& parameters)
{
    const FitState state = startFit(problem, start);
    std::vector<float> values = parameters.download();
    const ParameterSlice& weight = parameters.layout().slice("head.weight");
    for (std::uint32_t i = 0; i < weight.count; ++i)
        values[weight.offset + i] *= kHeadWeightShare;
    const std::uint32_t bias = parameters.layout().slice("head.bias").offset;
    for (std::uint32_t k = 0; k < problem.lobes; ++k) {
        const auto component = [&](std::uint32_t c) {
            return state.parameters[gpu::sgFitIndex(k, c, 0, problem.texelCount())];
        };
        float* raw = values.data() + bias + std::size_t(k) * kRawComponents;
        for (std::uint32_t c = 0; c < 3; ++c)
            raw[c] = component(c);
        raw[3] = component(gpu::kSgFitSharpness) - gpu::kSgSharpnessOffset;
        // The decoder's softplus, inverted, of amplitude over mean radiance.
        const float amplitude = component(gpu::kSgFitAmplitude) / std::abs(problem.scales.front());
        for (std::uint32_t c = 4; c < kRawComponents; ++c)
            raw[c] = std::log(std::expm1(amplitude));
    }
    parameters.upload(values);
}

struct Encoder
{
    EncoderDesc net;
    Parameters parameters;
    Buffer directions; // float [S S, 3]
    Buffer weights;    // float [S S] solid angle, mean 1
    float perMean;
};

Encoder makeEncoder(Context& context, const FitProblem& problem, const FitSettings& settings)
{
    std::vector<glm::vec3> directions;
    std::vector<float> weights;
    for (const glm::vec4& d : problem.directions) {
        directions.emplace_back(d);
        weights.push_back(d.w * float(problem.directionCount()));
    }
    EncoderDesc net;
    net.imageSize = problem.size;
    net.lobes = problem.lobes;
    Encoder encoder{net, Parameters(context, net.parameters(), settings.seed),
                    Buffer::from(context, directions, "encoder directions"),
                    Buffer::from(context, weights, "encoder weights"),
                    float(1.0 / meanScale(problem))};
    startFromCommonLobes(problem, settings.start, encoder.parameters);
    return encoder;
}

double trainStep(Context& context, Encoder& encoder, const FitProblem& problem,
                 std::span<const std::uint32_t> texels, std::uint32_t step, double learningRate)
{
    RenderGraph graph(context);
    ParameterIds ids(graph, encoder.parameters);
    const TensorId image =
        uploadTensor(graph, "light-field images", encoder.net.input(std::uint32_t(texels.size())),
                     gatherImages(problem, texels, encoder.perMean));
    EncoderTraining training;
    training.loss = LossKind::MeanSquare;
    training.adam.learningRate = learningRate;
    training.weights =
        LossWeights{graph.importBuffer(encoder.weights), problem.directionCount(), 1};
    const EncoderStep result = addEncoderTrainingStep(
        graph, encoder.net, ids, image, graph.importBuffer(encoder.directions), training, step);
    graph.output(result.loss);
    graph.execute();
    return double(graph.read<float>(result.loss).front());
}

// Decoded lobes [N, L, 7] of some texels: axis, sharpness, amplitude over the mean.
std::vector<float> encode(Context& context, Encoder& encoder, const FitProblem& problem,
                          std::span<const std::uint32_t> texels)
{
    const auto count = std::uint32_t(texels.size());
    RenderGraph graph(context);
    const ParameterIds ids(graph, encoder.parameters);
    const TensorId image = uploadTensor(graph, "light-field images", encoder.net.input(count),
                                        gatherImages(problem, texels, encoder.perMean));
    const SgMixtureDesc mixture{
        .images = count, .lobes = problem.lobes, .directions = problem.directionCount()};
    const TensorId lobes =
        addSgDecodePass(graph, mixture, encoderForward(graph, encoder.net, ids, image).raw);
    graph.output(lobes.buffer);
    graph.execute();
    return graph.read<float>(lobes.buffer);
}

// Gives every texel without image the mean of its neighbours, ring by ring; one that no ring
// reaches keeps the default.
void fillTexelsWithoutImage(const FitProblem& problem, SgField& field)
{
    const std::size_t texelCount = problem.texelCount(), lobes = field.lobeCount;
    std::vector<bool> known(texelCount);
    for (std::size_t t = 0; t < texelCount; ++t)
        known[t] = problem.scales[t] > 0.0f;
    for (bool grew = true; grew;) {
        grew = false;
        std::vector<bool> next = known;
        for (std::size_t t = 0; t < texelCount; ++t) {
            std::vector<std::uint32_t> sources;
            for (std::size_t n = 0; n < 4 && !known[t]; ++n) {
                const std::uint32_t other = problem.cells.neighbours[n * texelCount + t];
                if (other != gpu::kSgFitNone && known[other])
                    sources.push_back(other);
            }
            if (sources.empty())
                continue;
            for (std::size_t k = 0; k < lobes; ++k) {
                SgLobe mean{glm::vec3(0.0f), 0.0f, glm::vec3(0.0f)};
                const float share = 1.0f / float(sources.size());
                for (const std::uint32_t source : sources) {
                    const SgLobe& lobe = field.lobes[source * lobes + k];
                    mean.axis += share * lobe.axis;
                    mean.logSharpness += share * lobe.logSharpness;
                    mean.amplitude += share * lobe.amplitude;
                }
                mean.axis = gpu::safeNormalize(mean.axis, glm::vec3(0.0f, 0.0f, 1.0f));
                field.lobes[t * lobes + k] = mean;
            }
            next[t] = true;
            grew = true;
        }
        known = std::move(next);
    }
}

SgField encodeAll(Context& context, Encoder& encoder, const FitProblem& problem)
{
    SgField field;
    field.lobeCount = problem.lobes;
    field.lobes.resize(std::size_t(problem.texelCount()) * problem.lobes);
    std::vector<std::uint32_t> all(problem.texelCount());
    std::iota(all.begin(), all.end(), 0u);
    for (std::size_t first = 0; first < all.size(); first += kTexelsPerStep) {
        const auto texels = std::span(all).subspan(
            first, std::min<std::size_t>(kTexelsPerStep, all.size() - first));
        const std::vector<float> lobes = encode(context, encoder, problem, texels);
        STRANDLIGHT_ASSERT_EQ(lobes.size(), texels.size() * problem.lobes * kRawComponents);
        for (std::size_t i = 0; i < texels.size() * problem.lobes; ++i) {
            const float* values = lobes.data() + i * kRawComponents;
            field.lobes[first * problem.lobes + i] = {{values[0], values[1], values[2]},
                                                      std::log(values[3]),
                                                      glm::vec3(values[4], values[5], values[6]) /
                                                          encoder.perMean};
        }
    }
    fillTexelsWithoutImage(problem, field);
    return field;
}

void train(Context& context, Encoder& encoder, const FitProblem& problem,
           const FitSettings& settings, FitStatistics& statistics, FitWatch* watch)
{
    std::vector<std::uint32_t> order = shuffledTexels(problem, 0, settings.seed);
    const auto batches = std::uint32_t((order.size() + kTexelsPerStep - 1) / kTexelsPerStep);
    const std::uint32_t steps = settings.cnnSteps;
    Progress progress("train", steps);
    for (std::uint32_t step = 0; step < steps; ++step) {
        throwIfInterrupted();
        if (step > 0 && step % batches == 0)
            order = shuffledTexels(problem, step / batches, settings.seed);
        const std::size_t first = std::size_t(step % batches) * kTexelsPerStep;
        const auto texels = std::span(order).subspan(
            first, std::min<std::size_t>(kTexelsPerStep, order.size() - first));
        const double rate = kLearningRate * std::exp2(-double(3 * step / steps));
        statistics.lastLoss = trainStep(context, encoder, problem, texels, step + 1, rate);
        if (step == 0)
            statistics.firstLoss = statistics.lastLoss;
        progress.update(step + 1);
        if (watch)
            watch->update(problem, [&] { return encodeAll(context, encoder, problem); });
    }
    statistics.skippedSteps = encoder.parameters.report().stepsSkipped;
}

} // namespace

SgField fitLobesByCnn(Context& context, const FitProblem& problem, const FitSettings& settings,
                      FitStatistics& statistics, FitWatch* watch)
{
    Encoder encoder = makeEncoder(context, problem, settings);
    train(context, encoder, problem, settings, statistics, watch);
    return encodeAll(context, encoder, problem);
}

TrainingMemory encoderTrainingMemory(Context& context, std::uint32_t imageSize, std::uint32_t lobes)
{
    EncoderDesc net;
    net.imageSize = imageSize;
    net.lobes = lobes;
    const TensorDesc input = net.input(kTexelsPerStep);
    const std::vector<float> zeros(std::max<std::size_t>(input.elements(), input.pixels() * 3));
    Parameters parameters(context, net.parameters(), 1);
    RenderGraph graph(context);
    ParameterIds ids(graph, parameters);
    EncoderTraining training;
    training.weights = LossWeights{
        graph.uploadBuffer("weights", std::span(zeros).first(input.pixels())), input.pixels(), 1};
    const EncoderStep step = addEncoderTrainingStep(
        graph, net, ids,
        uploadTensor(graph, "light-field images", input, std::span(zeros).first(input.elements())),
        graph.uploadBuffer("directions", std::span(zeros).first(input.pixels() * 3)), training, 1);
    graph.output(step.loss);
    return planTrainingMemory(parameters.layout(), graph.compile());
}

} // namespace strandlight
