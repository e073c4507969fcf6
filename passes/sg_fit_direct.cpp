#include "passes/sg_fit_direct.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "kernels/sg_fit.gen.hpp"
#include "shaders/shared/sg_fit_types.h"

namespace strandlight {
namespace {

// A dispatch of this many cells, 8 lobes and 64 directions takes about 30 ms on two cores of the
// reference device.
constexpr std::uint32_t kCellsPerDispatch = 32768;
// Texel buffers of every device we know hold 2^27 elements.
constexpr std::uint64_t kTexelBufferWords = std::uint64_t(1) << 27;

// Words [direction, texel of the chunk] out of words [direction, texel].
std::vector<std::uint32_t> imagesOf(const FitProblem& problem, const SgFitChunk& chunk)
{
    std::vector<std::uint32_t> words;
    words.reserve(std::size_t(problem.directionCount()) * chunk.texelCount);
    for (std::uint32_t d = 0; d < problem.directionCount(); ++d) {
        const auto row = problem.images.begin() +
                         std::ptrdiff_t(std::size_t(d) * problem.texelCount() + chunk.firstTexel);
        words.insert(words.end(), row, row + chunk.texelCount);
    }
    return words;
}

void checkLimit(const Context& context, const char* what, std::uint64_t words)
{
    if (words > kTexelBufferWords || words * 4 > context.maxStorageBufferBytes())
        throw Error(
            std::string("fit: ") + what + " take " + std::to_string(words * 4) +
            " bytes, the device binds at most " +
            std::to_string(std::min(kTexelBufferWords * 4, context.maxStorageBufferBytes())) +
            "; use a smaller atlas or fewer lobes");
}

std::vector<SgFitChunk> chunksOf(const Context& context, const FitProblem& problem)
{
    return splitFitCells(problem, std::min(kTexelBufferWords * 4, context.maxStorageBufferBytes()),
                         kCellsPerDispatch);
}

} // namespace

std::vector<SgFitChunk> splitFitCells(const FitProblem& problem, std::uint64_t imageBytes,
                                      std::uint32_t maximumCells)
{
    const std::uint64_t bytesPerTexel = std::uint64_t(problem.directionCount()) * 4;
    std::vector<SgFitChunk> chunks;
    for (std::uint32_t cell = 0; cell < problem.cells.cellCount;) {
        SgFitChunk chunk;
        chunk.firstCell = cell;
        std::uint32_t low = ~0u, high = 0;
        for (; cell < problem.cells.cellCount && chunk.cellCount < maximumCells; ++cell) {
            const glm::uvec4 corners = problem.cells.cornersOf(cell);
            const auto [least, most] = std::minmax({corners.x, corners.y, corners.z, corners.w});
            const std::uint64_t texels =
                std::uint64_t(std::max(high, most)) - std::min(low, least) + 1;
            if (chunk.cellCount > 0 && texels * bytesPerTexel > imageBytes)
                break;
            low = std::min(low, least);
            high = std::max(high, most);
            ++chunk.cellCount;
        }
        chunk.firstTexel = low;
        chunk.texelCount = high - low + 1;
        chunks.push_back(chunk);
    }
    return chunks;
}

std::uint64_t directFitBytes(const Context& context, const FitProblem& problem)
{
    const std::uint64_t texels = problem.texelCount(), cells = problem.cells.cellCount;
    const std::uint64_t lobeBytes = problem.lobes * gpu::kSgFitLobeFloats * sizeof(float);
    std::uint64_t bytes = 0;
    for (const SgFitChunk& chunk : chunksOf(context, problem))
        bytes += std::uint64_t(chunk.texelCount) * problem.directionCount() * 4;
    bytes += cells * 16 + texels * (16 + 16 + 4); // corners, gather, neighbours, scales
    bytes += problem.directionCount() * sizeof(glm::vec4);
    bytes += 3 * lobeBytes * texels;  // parameters before and after, first moments
    bytes += lobeBytes * texels / 2;  // second moments
    bytes += (lobeBytes + 4) * cells; // gradients, losses
    return bytes + 4;                 // the counter
}

void addSgFitStepPass(RenderGraph& graph, const SgFitShape& shape, SgFitStepIds& ids,
                      std::uint32_t step)
{
    PassBuilder pass = graph.addComputePass("sg fit step");
    const FitSettings& settings = shape.settings;
    for (const BufferId id :
         {ids.corners, ids.gather, ids.neighbours, ids.directions, ids.scales, ids.before})
        pass.read(id);
    for (const BufferId id : ids.images)
        pass.read(id);
    ids.gradients = pass.write(ids.gradients);
    ids.losses = pass.write(ids.losses);
    ids.after = pass.write(ids.after);
    ids.moments1 = pass.write(ids.moments1);
    ids.moments2 = pass.write(ids.moments2);
    ids.counters = pass.write(ids.counters);

    for (std::size_t c = 0; c < shape.chunks.size(); ++c) {
        const SgFitChunk& chunk = shape.chunks[c];
        const gpu::SgFitCellPush push{.texelCount = shape.texelCount,
                                      .cellCount = shape.cellCount,
                                      .firstCell = chunk.firstCell,
                                      .chunkCells = chunk.cellCount,
                                      .firstTexel = chunk.firstTexel,
                                      .imageTexels = chunk.texelCount,
                                      .directionCount = shape.directionCount,
                                      .directionsPerStep = shape.directionsPerStep,
                                      .step = step,
                                      .seed = settings.seed,
                                      .cornerFraction = settings.cornerFraction,
                                      .peakSoftening = settings.peakSoftening};
        pass.dispatch(kernels::sg_fit_cells, {chunk.cellCount, 1, 1}, push,
                      {ids.corners, ids.images[c], ids.directions, ids.before, ids.scales,
                       ids.gradients, ids.losses},
                      {shape.lobes});
    }

    const double t = double(step) + 1.0;
    const gpu::SgFitUpdatePush push{
        .texelCount = shape.texelCount,
        .cellCount = shape.cellCount,
        .step = step,
        .seed = settings.seed,
        .cornerFraction = settings.cornerFraction,
        .smoothness = float(fitSmoothness(settings, step)),
        .learningRate = float(fitLearningRate(settings, step)),
        .inverseCorrection1 = float(1.0 / (1.0 - std::pow(double(gpu::kSgFitBeta1), t))),
        .inverseCorrection2 = float(1.0 / (1.0 - std::pow(double(gpu::kSgFitBeta2), t))),
        .minimumLogSharpness = shape.minimumLogSharpness,
        .maximumLogSharpness = shape.maximumLogSharpness};
    pass.dispatch(kernels::sg_fit_update, {shape.texelCount, shape.lobes, 1}, push,
                  {ids.gather, ids.neighbours, ids.scales, ids.gradients, ids.before, ids.after,
                   ids.moments1, ids.moments2, ids.counters});
    std::swap(ids.before, ids.after);
}

DirectFit::DirectFit(Context& context, const FitProblem& problem, const FitSettings& settings,
                     const FitState& start)
    : context_(&context), step_(start.step), skippedBefore_(start.skippedSteps)
{
    const std::uint64_t texels = problem.texelCount();
    const std::uint64_t floats = std::uint64_t(problem.lobes) * gpu::kSgFitLobeFloats;
    STRANDLIGHT_ASSERT_EQ(start.parameters.size(), floats * texels);
    checkLimit(context, "lobe parameters", floats * texels);
    checkLimit(context, "cell gradients", floats * problem.cells.cellCount);

    shape_.texelCount = problem.texelCount();
    shape_.cellCount = problem.cells.cellCount;
    shape_.lobes = problem.lobes;
    shape_.directionCount = problem.directionCount();
    shape_.directionsPerStep = fitDirectionsPerStep(settings, problem.directionCount());
    shape_.minimumLogSharpness = problem.minimumLogSharpness;
    shape_.maximumLogSharpness = problem.maximumLogSharpness;
    shape_.settings = settings;
    shape_.chunks = chunksOf(context, problem);

    for (const SgFitChunk& chunk : shape_.chunks)
        images_.push_back(Buffer::from(context, imagesOf(problem, chunk), "fit images"));
    corners_ = Buffer::from(context, problem.cells.corners, "fit corners");
    gather_ = Buffer::from(context, problem.cells.gather, "fit gather");
    neighbours_ = Buffer::from(context, problem.cells.neighbours, "fit neighbours");
    directions_ = Buffer::from(context, problem.directions, "fit directions");
    scales_ = Buffer::from(context, problem.scales, "fit scales");
    for (Buffer& buffer : parameters_)
        buffer = Buffer::from(context, start.parameters, "fit parameters");
    moments1_ = Buffer::from(context, start.firstMoments, "fit first moments");
    moments2_ = Buffer::from(context, start.secondMoments, "fit second moments");
    gradients_ = Buffer(context, floats * shape_.cellCount * 4, "fit gradients");
    losses_ = Buffer(context, std::uint64_t(shape_.cellCount) * 4, "fit losses");
    counters_ = Buffer(context, 4, "fit counters");
}

SgFitStepIds DirectFit::import(RenderGraph& graph)
{
    SgFitStepIds ids;
    for (Buffer& buffer : images_)
        ids.images.push_back(graph.importBuffer(buffer));
    ids.corners = graph.importBuffer(corners_);
    ids.gather = graph.importBuffer(gather_);
    ids.neighbours = graph.importBuffer(neighbours_);
    ids.directions = graph.importBuffer(directions_);
    ids.scales = graph.importBuffer(scales_);
    ids.before = graph.importBuffer(parameters_[step_ % 2]);
    ids.after = graph.importBuffer(parameters_[(step_ + 1) % 2]);
    ids.moments1 = graph.importBuffer(moments1_);
    ids.moments2 = graph.importBuffer(moments2_);
    ids.gradients = graph.importBuffer(gradients_);
    ids.losses = graph.importBuffer(losses_);
    ids.counters = graph.importBuffer(counters_);
    return ids;
}

void DirectFit::run(std::uint32_t steps)
{
    RenderGraph graph(*context_);
    SgFitStepIds ids = import(graph);
    for (std::uint32_t i = 0; i < steps; ++i)
        addSgFitStepPass(graph, shape_, ids, step_ + i);
    graph.execute();
    step_ += steps;
}

FitState DirectFit::state() const
{
    FitState state;
    state.step = step_;
    state.parameters = parameters_[step_ % 2].downloadAs<float>();
    state.firstMoments = moments1_.downloadAs<float>();
    state.secondMoments = moments2_.downloadAs<float>();
    state.skippedSteps = skippedBefore_ + counters_.downloadAs<std::uint32_t>().front();
    return state;
}

double DirectFit::loss() const
{
    const std::vector<float> losses = losses_.downloadAs<float>();
    return std::accumulate(losses.begin(), losses.end(), 0.0) / double(losses.size());
}

} // namespace strandlight
