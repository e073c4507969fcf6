#include "passes/gi_study.hpp"

#include "engine/base/progress.hpp"

namespace strandlight {
namespace {

struct Case
{
    const char* knob;
    GiChoice choice;
};
using Cases = std::vector<Case>;

GiChoice withEveryLobe(GiChoice choice)
{
    choice.lobeError = 0.0f;
    return choice;
}

void addRepresentations(const GiSweep& sweep, Cases& cases)
{
    const auto add = [&](const std::string& representation, std::uint32_t lobes) {
        GiChoice choice = withEveryLobe(sweep.base);
        choice.representation = representation;
        choice.lobes = lobes;
        cases.push_back({"representation", choice});
    };
    for (const char* rival : {"raw images", "SH L1", "SH L2"})
        add(rival, 0);
    for (const std::uint32_t lobes : sweep.fixedLobes)
        add("fixed SGs", lobes);
    for (const std::string& fit : sweep.fits)
        add(fit, sweep.base.lobes);
}

void addLobes(const GiSweep& sweep, Cases& cases)
{
    for (const std::uint32_t lobes : sweep.lobes)
        for (const GiStorage storage : {GiStorage::Fp32, GiStorage::Fp16, GiStorage::Packed}) {
            GiChoice choice = withEveryLobe(sweep.base);
            choice.lobes = lobes;
            choice.storage = storage;
            cases.push_back({"lobes and storage", choice});
        }
}

void addDropped(const GiSweep& sweep, Cases& cases)
{
    cases.push_back({"dropped lobes", sweep.base});
    for (const float lobeError : sweep.lobeErrors) {
        GiChoice choice = sweep.base;
        choice.lobeError = lobeError;
        cases.push_back({"dropped lobes", choice});
    }
}

void addSizes(const GiSweep& sweep, Cases& cases)
{
    const auto add = [&](const char* knob, const std::vector<std::uint32_t>& values,
                         std::uint32_t GiChoice::*size) {
        for (const std::uint32_t value : values) {
            GiChoice choice = sweep.base;
            choice.*size = value;
            cases.push_back({knob, choice});
        }
    };
    add("atlas", sweep.atlases, &GiChoice::atlas);
    add("light field", sweep.lightfields, &GiChoice::lightfield);
    add("samples", sweep.samples, &GiChoice::samples);
}

void addShading(const GiSweep& sweep, Cases& cases)
{
    for (const SpecularModel model :
         {SpecularModel::Mixture, SpecularModel::NdfFilter, SpecularModel::Asg}) {
        GiChoice choice = sweep.base;
        choice.specular = model;
        cases.push_back({"shading", choice});
    }
    for (const DiffuseModel model : {DiffuseModel::Hill, DiffuseModel::Wang}) {
        GiChoice choice = sweep.base;
        choice.diffuse = model;
        cases.push_back({"shading", choice});
    }
}

} // namespace

GiSweep smallGiSweep()
{
    GiSweep sweep;
    sweep.base.atlas = 56; // at 40 texels a side most charts share a texel
    sweep.lobes = {2, 4, 7, 8, 12, 16};
    sweep.lobeErrors = {0.05f};
    sweep.atlases = {48, 56, 72};
    sweep.lightfields = {8, 12, 16};
    sweep.samples = {1, 2, 4, 8};
    return sweep;
}

GiMeasureSettings smallGiMeasure()
{
    GiMeasureSettings settings;
    settings.width = 160;
    settings.height = 120;
    settings.frames = 3;
    settings.truthSamples = 128;
    settings.fit.probes = 192;
    settings.fit.probeSamples = 32;
    return settings;
}

GiStudy studyGi(Context& context, const Scene& scene, const GiSweep& sweep,
                const GiMeasureSettings& settings, const GiStudyWatch& watch)
{
    Cases cases;
    addRepresentations(sweep, cases);
    addLobes(sweep, cases);
    addDropped(sweep, cases);
    addSizes(sweep, cases);
    addShading(sweep, cases);

    GiMeasure measure(context, scene, settings);
    GiStudy study;
    for (const std::string& fit : sweep.fits) {
        GiChoice choice = withEveryLobe(sweep.base);
        choice.representation = fit;
        const std::vector<GiTracePoint> trace = measure.trace(choice);
        study.traces.insert(study.traces.end(), trace.begin(), trace.end());
    }
    study.rows.push_back(measure.measure("base", sweep.base));
    study.truth = measure.truth();
    study.frame = measure.lastFrame();
    study.savings = measure.lastSavings();
    study.picture = study.frame.radiance;
    for (const Case& c : cases) {
        throwIfInterrupted();
        study.rows.push_back(measure.measure(c.knob, c.choice));
        if (watch)
            watch(study);
    }
    return study;
}

} // namespace strandlight
