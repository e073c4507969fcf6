#include "passes/bake.hpp"

#include <chrono>
#include <utility>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "passes/bake_checkpoint.hpp"
#include "passes/bake_identity.hpp"
#include "passes/fit_report.hpp"
#include "passes/light_field_baselines.hpp"
#include "passes/lightfield_capture.hpp"
#include "passes/sg_fit.hpp"
#include "passes/texel_gloss.hpp"

namespace strandlight {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSecondsBetweenSaves = 15.0; // what a kill -9 may cost at most

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

FitSettings fitSettings(const BakeSettings& settings, LightSet light)
{
    FitSettings fit;
    fit.mode = settings.fit;
    fit.lobes = light == LightSet::Radiance ? settings.lobes : settings.environmentLobes;
    fit.steps = settings.steps;
    fit.seed = settings.seed;
    fit.lobeError = settings.lobeError;
    fit.lobeTile = settings.lobeTile;
    return fit;
}

// Keeps the checkpoint file up to date; does nothing without a path.
class Saver
{
public:
    Saver(const BakeSettings& settings, std::uint64_t hash) : path_(settings.checkpoint)
    {
        if (settings.resume && !path_.empty() && std::filesystem::exists(path_))
            state = loadCheckpoint(path_, hash);
        state.settingsHash = hash;
    }
    void save() const
    {
        if (!path_.empty())
            saveCheckpoint(path_, state);
    }
    bool active() const { return !path_.empty(); }

    BakeCheckpoint state;

private:
    std::filesystem::path path_;
};

Lightfield capture(Context& context, const Scene& scene, GpuScene& device, const Atlas& atlas,
                   const BakeSettings& settings, Saver& saver, BakeStatistics& numbers)
{
    CaptureSettings wanted;
    wanted.size = settings.lightfieldSize;
    wanted.samplesPerDirection = settings.samplesPerDirection;
    wanted.bounces = settings.bounces;
    wanted.seed = settings.seed;
    LightfieldCapture work(context, device, capturePoints(scene, atlas), wanted);
    if (!saver.state.capture.empty())
        work.restore(saver.state.capture);

    Progress progress("capture", work.texelCount());
    Clock::time_point lastSave = Clock::now();
    try {
        while (!work.step()) {
            progress.update(work.completedTexels());
            if (saver.active() && secondsSince(lastSave) > kSecondsBetweenSaves) {
                saver.state.capture = work.save();
                saver.save();
                lastSave = Clock::now();
            }
        }
    } catch (const Interrupted&) {
        saver.state.capture = work.save();
        saver.save();
        throw;
    }
    progress.update(work.texelCount());
    if (saver.active()) {
        saver.state.capture = work.save();
        saver.save();
    }
    numbers.captureDispatches = work.statistics().dispatches;
    return work.finish();
}

SgField fit(Context& context, const FitProblem& problem, const FitSettings& settings,
            std::optional<FitState>& progress, Saver& saver)
{
    const std::optional<FitState> resumed = progress;
    FitCheckpoint checkpoint;
    checkpoint.resume = resumed ? &*resumed : nullptr;
    checkpoint.secondsBetweenSaves = kSecondsBetweenSaves;
    if (saver.active())
        checkpoint.save = [&](const FitState& state) {
            progress = state;
            saver.save();
        };
    return fitLobes(context, problem, settings, nullptr, &checkpoint);
}

double rmseAtTexels(const FitProblem& problem, const SgField& field)
{
    const FitReport report =
        compareFits(problem, FitProbes{}, {freeSgModel(problem, field, "bake", 0.0)}, 1024);
    return report.rows.empty() ? 0.0 : report.rows[0].texelRmse;
}

SgField darkField(const Atlas& atlas, std::uint32_t lobes, std::uint32_t tileSize)
{
    SgField field;
    field.lobeCount = lobes;
    field.lobes.resize(atlas.texels.size() * lobes);
    field.tileSize = tileSize;
    field.kept.assign(atlas.texels.size(), 0u);
    return field;
}

// Images of all texels, then lobes for them.
void captureAndFit(Context& context, const Scene& scene, const BakeSettings& settings, SgBake& bake,
                   BakeStatistics& numbers)
{
    Saver saver(settings, hashBake(scene, settings));
    Clock::time_point start = Clock::now();
    GpuScene device = uploadScene(context, scene);
    CpuLightfield images;
    {
        const Lightfield field =
            capture(context, scene, device, bake.atlas, settings, saver, numbers);
        images = downloadLightfield(
            field); // the device's copy goes: the fit lays the images out for itself
    }
    numbers.captureSeconds = secondsSince(start);
    for (const std::uint8_t valid : images.valid)
        numbers.skippedTexels += valid == 0;

    // Lobes of the light that the scene sends back
    start = Clock::now();
    const std::vector<float> gloss =
        settings.lobeError > 0.0f ? texelGloss(scene, bake.atlas) : std::vector<float>();
    {
        const FitSettings wanted = fitSettings(settings, LightSet::Radiance);
        FitProblem problem = buildFitProblem(bake.atlas, images, LightSet::Radiance, wanted);
        problem.gloss = gloss;
        bake.radiance = saver.state.radiance
                            ? *saver.state.radiance
                            : fit(context, problem, wanted, saver.state.radianceFit, saver);
        numbers.radianceRmse = rmseAtTexels(problem, bake.radiance);
    }
    // Lobes of the distant environment, as far as it is seen
    if (!images.environment.empty()) {
        saver.state.radiance = bake.radiance;
        saver.state.radianceFit.reset();
        saver.save();
        const FitSettings wanted = fitSettings(settings, LightSet::Environment);
        FitProblem problem = buildFitProblem(bake.atlas, images, LightSet::Environment, wanted);
        problem.gloss = gloss;
        bake.environment = fit(context, problem, wanted, saver.state.environmentFit, saver);
        numbers.environmentRmse = rmseAtTexels(problem, *bake.environment);
    }
    numbers.fitSeconds = secondsSince(start);
}

} // namespace

SgBake bakeScene(Context& context, const Scene& scene, const BakeSettings& settings,
                 BakeStatistics* statistics)
{
    BakeStatistics numbers;
    const Clock::time_point start = Clock::now();
    SgBake bake;
    bake.atlas.resolution = settings.atlasResolution;
    if (!scene.triangles.empty())
        bake.atlas = buildAtlas(scene, {.resolution = settings.atlasResolution});
    numbers.atlasSeconds = secondsSince(start);
    numbers.texels = std::uint32_t(bake.atlas.texels.size());
    numbers.emptyTexels = settings.atlasResolution * settings.atlasResolution - numbers.texels;

    if (!scene.environment)
        numbers.skipped.push_back("environment lobes: the scene has no environment");
    if (!bake.atlas.texels.empty() && sendsLight(scene)) {
        captureAndFit(context, scene, settings, bake, numbers);
    } else {
        numbers.skipped.push_back(std::string("capture and fit: ") + (bake.atlas.texels.empty()
                                                                          ? "there is no surface"
                                                                          : "nothing sends light"));
        bake.radiance = darkField(bake.atlas, settings.lobes, settings.lobeTile);
        if (scene.environment)
            bake.environment = darkField(bake.atlas, settings.environmentLobes, settings.lobeTile);
    }
    numbers.savings = bakeSavings(bake);

    BakeInfo& info = bake.info;
    info.scene = scene.name;
    info.fitMode = toString(settings.fit);
    info.geometryHash = hashGeometry(scene);
    info.environmentHash = hashEnvironment(scene);
    info.lightfieldSize = settings.lightfieldSize;
    info.samplesPerDirection = settings.samplesPerDirection;
    info.bounces = settings.bounces;
    info.steps = settings.steps;
    info.seed = settings.seed;
    info.rmse = float(numbers.radianceRmse);
    numbers.peakDeviceBytes = context.peakBytesAllocated();
    if (statistics)
        *statistics = numbers;
    return bake;
}

} // namespace strandlight
