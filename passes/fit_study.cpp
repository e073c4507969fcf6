#include "passes/fit_study.hpp"

#include <cstdio>
#include <utility>

#include "engine/base/progress.hpp"
#include "passes/fit_probes.hpp"
#include "passes/sg_fit.hpp"
#include "passes/texel_gloss.hpp"

namespace strandlight {

FitReport studyFits(Context& context, const Scene& scene, const FitStudySettings& settings)
{
    const Atlas atlas = buildAtlas(scene, {.resolution = settings.atlasResolution});
    GpuScene device = uploadScene(context, scene);
    const CpuLightfield field =
        captureTexels(context, scene, device, atlas, atlas.texels, settings.capture, "capture");
    FitProblem problem = buildFitProblem(atlas, field, LightSet::Radiance, settings.fit);
    problem.gloss = texelGloss(scene, atlas);

    CaptureSettings between = settings.capture;
    between.seed += 1; // noise of its own
    const FitProbes probes =
        captureProbes(context, scene, device, atlas, problem, settings.probes, between);

    // The raw row keeps every image: what is wrong between texels there is parallax and noise, not
    // the model.
    std::vector<LightFieldModel> models{rawImageModel(problem), sphericalHarmonicModel(problem, 2),
                                        sphericalHarmonicModel(problem, 3),
                                        fixedSgModel(problem, settings.fit.lobes)};
    for (const FitMode mode : settings.modes) {
        throwIfInterrupted();
        FitSettings fit = settings.fit;
        fit.mode = mode;
        FitStatistics statistics;
        SgField lobes = fitLobes(context, problem, fit, &statistics);
        models.push_back(
            freeSgModel(problem, std::move(lobes), toString(mode), statistics.seconds));
    }
    for (const float lobeError : settings.lobeErrors) {
        FitSettings fit = settings.fit;
        fit.mode = FitMode::Direct;
        fit.lobeError = lobeError;
        FitStatistics statistics;
        SgField lobes = fitLobes(context, problem, fit, &statistics);
        char name[32];
        std::snprintf(name, sizeof(name), "direct, %g dropped", double(lobeError));
        models.push_back(freeSgModel(problem, std::move(lobes), name, statistics.seconds));
    }
    return compareFits(problem, probes, models);
}

} // namespace strandlight
