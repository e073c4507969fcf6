#include "passes/gi_fits.hpp"

#include <chrono>
#include <utility>

#include "engine/base/error.hpp"
#include "passes/fit_probes.hpp"
#include "passes/sg_fit.hpp"
#include "passes/texel_gloss.hpp"

namespace strandlight {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string captureKey(const GiChoice& c)
{
    return std::to_string(c.atlas) + " " + std::to_string(c.lightfield) + " " +
           std::to_string(c.samples);
}

std::string fitKey(const GiChoice& c)
{
    return captureKey(c) + " " + std::to_string(c.lobes) + " " + c.representation + " " +
           std::to_string(c.lobeError) + " " + std::to_string(c.lobeTile);
}

LightFieldModel rival(const FitProblem& problem, const GiChoice& choice)
{
    if (choice.representation == "raw images")
        return rawImageModel(problem);
    if (choice.representation == "SH L1" || choice.representation == "SH L2")
        return sphericalHarmonicModel(problem, choice.representation == "SH L1" ? 2 : 3);
    if (choice.representation == "fixed SGs")
        return fixedSgModel(problem, choice.lobes);
    throw Error("'" + choice.representation + "' is no way to keep a light field");
}

} // namespace

double GiBetween::rmse(const LightFieldModel& model) const
{
    return compareFits(view, probes, {model}).rows[0].interpolatedRmse;
}

const GiCapture& GiFits::captured(const GiChoice& choice)
{
    const auto known = captures_.find(captureKey(choice));
    if (known != captures_.end())
        return known->second;
    GiCapture capture;
    Clock::time_point start = Clock::now();
    capture.atlas = buildAtlas(scene_, {.resolution = choice.atlas});
    const CaptureSettings wanted{.size = choice.lightfield,
                                 .samplesPerDirection = choice.samples,
                                 .bounces = settings_.bake.bounces,
                                 .seed = settings_.bake.seed};
    capture.captureSeconds = secondsSince(start);
    if (captures_.empty() && !capture.atlas.texels.empty()) // compiling is not the method's time
        captureTexels(context_, scene_, device_, capture.atlas, {capture.atlas.texels.front()},
                      wanted, "warm-up");
    start = Clock::now();
    const CpuLightfield images = captureTexels(context_, scene_, device_, capture.atlas,
                                               capture.atlas.texels, wanted, "capture");
    capture.captureSeconds += secondsSince(start);
    FitSettings fit;
    capture.problem = buildFitProblem(capture.atlas, images, LightSet::Radiance, fit);
    capture.problem.gloss = texelGloss(scene_, capture.atlas);
    if (!images.environment.empty()) {
        start = Clock::now();
        fit.lobes = settings_.bake.environmentLobes;
        fit.steps = settings_.bake.steps;
        fit.seed = settings_.bake.seed;
        capture.environment = fitLobes(
            context_, buildFitProblem(capture.atlas, images, LightSet::Environment, fit), fit);
        capture.environmentSeconds = secondsSince(start);
    }
    return captures_.emplace(captureKey(choice), std::move(capture)).first->second;
}

const GiBetween& GiFits::between(const GiChoice& choice)
{
    const auto known = betweens_.find(std::to_string(choice.atlas));
    if (known != betweens_.end())
        return known->second;
    const GiCapture& capture = captured(choice);
    GiBetween out;
    out.view.cells = capture.problem.cells;
    out.view.size = settings_.probeSize;
    out.view.directions = fitDirections(settings_.probeSize);
    out.view.scales.assign(capture.problem.texelCount(), -1.0f);
    const CaptureSettings wanted{.size = settings_.probeSize,
                                 .samplesPerDirection = settings_.probeSamples,
                                 .bounces = settings_.bake.bounces,
                                 .seed = settings_.bake.seed + 1}; // noise of its own
    out.probes = captureProbes(context_, scene_, device_, capture.atlas, capture.problem,
                               settings_.probes, wanted);
    return betweens_.emplace(std::to_string(choice.atlas), std::move(out)).first->second;
}

LightFieldModel GiFits::fitFree(const GiChoice& choice, std::vector<GiTracePoint>* trace)
{
    const GiCapture& capture = captured(choice);
    FitProblem problem = capture.problem;
    problem.lobes = choice.lobes;
    problem.tiles = lobeTiles(capture.atlas, choice.lobeTile);
    FitSettings fit;
    fit.lobeError = choice.lobeError;
    fit.lobeTile = choice.lobeTile;
    fit.mode = fitModeFrom(choice.representation);
    fit.lobes = choice.lobes;
    fit.steps = settings_.bake.steps;
    fit.seed = settings_.bake.seed;
    FitCheckpoint checkpoint;
    std::optional<FitState> start;
    double before = 0.0;
    if (fit.mode == FitMode::CnnRefine) { // the encoder is not trained twice
        GiChoice encoder = choice;
        encoder.representation = toString(FitMode::Cnn);
        const LightFieldModel& trained = fitted(encoder);
        before = trained.seconds;
        start = startFit(problem, *trained.lobes);
        checkpoint.resume = &*start;
    }
    const auto look = [&](const SgField& lobes, double seconds) {
        const GiBetween& truths = between(choice);
        trace->push_back({choice.representation, before + seconds,
                          truths.rmse(freeSgModel(truths.view, lobes, "", 0.0))});
    };
    FitWatch watch(look);
    // Each kind of step once before the clock runs: kernels compile for a number of lobes.
    FitSettings warm = fit;
    warm.steps = warm.cnnSteps = 1;
    fitLobes(context_, problem, warm);
    FitStatistics statistics;
    SgField lobes = fitLobes(context_, problem, fit, &statistics, start ? &checkpoint : nullptr,
                             trace ? &watch : nullptr);
    if (trace)
        look(lobes, statistics.seconds);
    return freeSgModel(capture.problem, std::move(lobes), choice.representation,
                       before + statistics.seconds);
}

const LightFieldModel& GiFits::fitted(const GiChoice& choice, std::vector<GiTracePoint>* trace)
{
    const std::string key = fitKey(choice);
    const auto known = fits_.find(key);
    if (known != fits_.end() && !trace)
        return known->second;
    LightFieldModel made =
        isFree(choice) ? fitFree(choice, trace) : rival(captured(choice).problem, choice);
    return fits_.insert_or_assign(key, std::move(made)).first->second;
}

} // namespace strandlight
