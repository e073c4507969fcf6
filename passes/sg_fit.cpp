#include "passes/sg_fit.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "passes/fit_report.hpp"
#include "passes/sg_fit_cnn.hpp"
#include "passes/sg_fit_coarse.hpp"
#include "passes/sg_fit_direct.hpp"
#include "passes/sg_fit_irradiance.hpp"
#include "passes/sg_prune.hpp"
#include "shaders/shared/sg_fit_types.h"

namespace strandlight {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// One submit is about this long, so that the user's wish to stop is heard soon.
constexpr double kSliceSeconds = 0.15;
constexpr std::uint32_t kMostStepsPerSlice = 64;
// Fewer than this are not joined to blocks.
constexpr std::uint32_t kFewestTexels = 256;

// Runs the fit to its last step, saving and listening on the way. Returns the first step's loss.
double runToEnd(const char* what, DirectFit& fit, const FitProblem& problem,
                const FitSettings& settings, double firstLoss, const FitCheckpoint* checkpoint,
                FitWatch* watch)
{
    Progress progress(what, settings.steps);
    const auto save = [&] {
        if (!checkpoint || !checkpoint->save)
            return;
        FitState state = fit.state();
        state.firstLoss = firstLoss;
        checkpoint->save(state);
    };
    Clock::time_point lastSave = Clock::now();
    std::uint32_t slice = 1;
    while (fit.step() < settings.steps) {
        if (interruptRequested()) {
            save();
            throwIfInterrupted();
        }
        const Clock::time_point start = Clock::now();
        const std::uint32_t before = fit.step();
        fit.run(std::min(slice, settings.steps - before));
        if (before == 0)
            firstLoss = fit.loss();
        progress.update(fit.step());
        if (watch)
            watch->update(problem, [&] { return fieldFromState(problem, fit.state()); });
        // How steps are cut into submits does not change the result.
        const double perStep = secondsSince(start) / double(fit.step() - before);
        slice = std::uint32_t(std::clamp(kSliceSeconds / perStep, 1.0, double(kMostStepsPerSlice)));
        if (checkpoint && secondsSince(lastSave) > checkpoint->secondsBetweenSaves) {
            save();
            lastSave = Clock::now();
        }
    }
    return firstLoss;
}

void countClamps(const FitProblem& problem, const SgField& field, FitStatistics& statistics)
{
    for (const SgLobe& lobe : field.lobes) {
        if (lobe.logSharpness <= problem.minimumLogSharpness ||
            lobe.logSharpness >= problem.maximumLogSharpness)
            ++statistics.sharpnessAtLimit;
        if (lobe.amplitude == glm::vec3(0.0f))
            ++statistics.amplitudesAtZero;
    }
    countDropped(problem, field, statistics);
    statistics.raisedScales = problem.raisedScales;
    statistics.texelsWithoutImage = std::uint64_t(std::count_if(
        problem.scales.begin(), problem.scales.end(), [](float s) { return s < 0.0f; }));
}

// The kept lobes find new places together, in small steps.
SgField refitKept(Context& context, const FitProblem& problem, const FitSettings& settings,
                  const SgField& field, const FitState& before, const FitCheckpoint* checkpoint)
{
    FitSettings refit = settings;
    refit.steps = settings.refitSteps;
    refit.learningRate = 0.3f * settings.learningRate;
    refit.coarseSmoothness = settings.smoothness;
    DirectFit fit(context, problem, refit, startFit(problem, field));
    // It is short: when it is interrupted, a resumed fit drops again from where it was before.
    FitCheckpoint outer;
    outer.secondsBetweenSaves = checkpoint ? checkpoint->secondsBetweenSaves : 0.0;
    if (checkpoint && checkpoint->save)
        outer.save = [&](const FitState&) { checkpoint->save(before); };
    runToEnd("refit", fit, problem, refit, 0.0, &outer, nullptr);
    SgField kept = fieldFromState(problem, fit.state());
    kept.tileSize = field.tileSize;
    kept.kept = field.kept;
    return kept;
}

FitState runDirect(Context& context, const FitProblem& problem, const FitSettings& settings,
                   const FitState& start, const FitCheckpoint* checkpoint, FitWatch* watch,
                   FitStatistics& statistics)
{
    if (start.parameters.size() !=
        std::size_t(problem.lobes) * problem.texelCount() * gpu::kSgFitLobeFloats)
        throw Error("fit: a state of " + std::to_string(start.parameters.size()) +
                    " parameters does not belong to " + std::to_string(problem.texelCount()) +
                    " texels of " + std::to_string(problem.lobes) + " lobes");
    DirectFit fit(context, problem, settings, start);
    statistics.firstLoss =
        runToEnd("fit", fit, problem, settings, start.firstLoss, checkpoint, watch);
    FitState state = fit.state();
    state.firstLoss = statistics.firstLoss;
    statistics.lastLoss = fit.loss();
    statistics.skippedSteps = state.skippedSteps;
    return state;
}

bool startsFromBlocks(const FitProblem& problem, const FitSettings& settings)
{
    return settings.coarseLevels > 0 && problem.texelCount() >= kFewestTexels;
}

// Of this level. Only the coarsest one looks for places, the others start in them; where there are
// too few texels for blocks, they take the steps of the levels that are missing.
FitSettings levelSettings(const FitProblem& problem, const FitSettings& settings)
{
    FitSettings level = settings;
    if (startsFromBlocks(problem, settings))
        level.coarseSmoothness = settings.smoothness;
    else
        level.steps = settings.steps << settings.coarseLevels;
    return level;
}

// From the coarsest blocks down; `problem` itself is not fitted.
FitState startFromBlocks(Context& context, const FitProblem& problem, const FitSettings& settings)
{
    if (!startsFromBlocks(problem, settings))
        return startFit(problem, settings.start);
    const CoarseProblem coarse = coarsen(problem);
    FitSettings level = settings;
    level.coarseLevels = settings.coarseLevels - 1;
    level.steps = 2 * settings.steps;
    const FitState start = startFromBlocks(context, coarse.problem, level);
    level = levelSettings(coarse.problem, level);
    DirectFit fit(context, coarse.problem, level, start);
    runToEnd("fit blocks", fit, coarse.problem, level, 0.0, nullptr, nullptr);
    SgField field = interpolateBlocks(problem, coarse, fieldFromState(coarse.problem, fit.state()));
    matchBrightness(problem, settings, field);
    return startFit(problem, field);
}

} // namespace

const char* toString(FitMode mode)
{
    return mode == FitMode::Direct ? "direct" : mode == FitMode::Cnn ? "cnn" : "cnn+refine";
}

FitMode fitModeFrom(const std::string& name)
{
    for (const FitMode mode : {FitMode::Direct, FitMode::Cnn, FitMode::CnnRefine})
        if (name == toString(mode))
            return mode;
    throw Error("unknown fit mode '" + name + "'; known are direct, cnn and cnn+refine");
}

SgField fitLobes(Context& context, const Atlas& atlas, const Lightfield& lightfield, LightSet light,
                 const FitSettings& settings, FitStatistics* statistics,
                 const FitCheckpoint* checkpoint)
{
    return fitLobes(context,
                    buildFitProblem(atlas, downloadLightfield(lightfield), light, settings),
                    settings, statistics, checkpoint);
}

SgField fitLobes(Context& context, const FitProblem& problem, const FitSettings& settings,
                 FitStatistics* statistics, const FitCheckpoint* checkpoint, FitWatch* watch)
{
    const Clock::time_point begin = Clock::now();
    if (watch)
        watch->start();
    FitStatistics numbers;
    SgField field;
    field.lobeCount = problem.lobes;
    if (problem.texelCount() > 0) {
        const FitState* resume = checkpoint ? checkpoint->resume : nullptr;
        FitState state;
        if (settings.mode == FitMode::Direct) {
            // Blocks are short: a fit that is interrupted there begins again, later it goes on.
            state = runDirect(context, problem, levelSettings(problem, settings),
                              resume ? *resume : startFromBlocks(context, problem, settings),
                              checkpoint, watch, numbers);
        } else {
            // The encoder is trained again when a bake is resumed: it is the same to the last bit.
            if (settings.mode == FitMode::Cnn || !resume)
                field = fitLobesByCnn(context, problem, settings, numbers, watch);
            FitSettings refine = settings;
            refine.coarseSmoothness = refine.smoothness; // the encoder has found the places
            if (settings.mode == FitMode::CnnRefine)
                state =
                    runDirect(context, problem, refine, resume ? *resume : startFit(problem, field),
                              checkpoint, watch, numbers);
        }
        if (settings.mode != FitMode::Cnn)
            field = fieldFromState(problem, state);
        numbers.heldIrradiance = matchIrradiance(problem, field);
        if (settings.lobeError > 0.0f) {
            const SgField whole = field;
            pruneLobes(problem, settings, field);
            if (settings.mode != FitMode::Cnn)
                field = refitKept(context, problem, settings, field, state, checkpoint);
            matchIrradianceOf(problem, whole, field);
        }
        countClamps(problem, field, numbers);
    }
    numbers.seconds = secondsSince(begin) - (watch ? watch->secondsLooking() : 0.0);
    if (statistics)
        *statistics = numbers;
    return field;
}

} // namespace strandlight
