#include "passes/gi_study.hpp"

#include <functional>

namespace strandlight {
namespace {

using Rows = std::vector<GiRow>;

GiChoice withEveryLobe(GiChoice choice)
{
    choice.lobeError = 0.0f;
    return choice;
}

void addRepresentations(GiMeasure& measure, const GiSweep& sweep, Rows& rows)
{
    const auto add = [&](const std::string& representation, std::uint32_t lobes) {
        GiChoice choice = withEveryLobe(sweep.base);
        choice.representation = representation;
        choice.lobes = lobes;
        rows.push_back(measure.measure("representation", choice));
    };
    for (const char* rival : {"raw images", "SH L1", "SH L2"})
        add(rival, 0);
    for (const std::uint32_t lobes : sweep.fixedLobes)
        add("fixed SGs", lobes);
    for (const std::string& fit : sweep.fits)
        add(fit, sweep.base.lobes);
}

void addLobes(GiMeasure& measure, const GiSweep& sweep, Rows& rows)
{
    for (const std::uint32_t lobes : sweep.lobes)
        for (const GiStorage storage : {GiStorage::Fp32, GiStorage::Fp16, GiStorage::Packed}) {
            GiChoice choice = withEveryLobe(sweep.base);
            choice.lobes = lobes;
            choice.storage = storage;
            rows.push_back(measure.measure("lobes and storage", choice));
        }
}

void addDropped(GiMeasure& measure, const GiSweep& sweep, Rows& rows)
{
    rows.push_back(measure.measure("dropped lobes", sweep.base));
    for (const float lobeError : sweep.lobeErrors) {
        GiChoice choice = sweep.base;
        choice.lobeError = lobeError;
        rows.push_back(measure.measure("dropped lobes", choice));
    }
}

void addSizes(GiMeasure& measure, const GiSweep& sweep, Rows& rows)
{
    const auto add = [&](const char* knob, const std::vector<std::uint32_t>& values,
                         std::uint32_t GiChoice::*size) {
        for (const std::uint32_t value : values) {
            GiChoice choice = sweep.base;
            choice.*size = value;
            rows.push_back(measure.measure(knob, choice));
        }
    };
    add("atlas", sweep.atlases, &GiChoice::atlas);
    add("light field", sweep.lightfields, &GiChoice::lightfield);
    add("samples", sweep.samples, &GiChoice::samples);
}

void addShading(GiMeasure& measure, const GiSweep& sweep, Rows& rows)
{
    for (const SpecularModel model :
         {SpecularModel::Mixture, SpecularModel::NdfFilter, SpecularModel::Asg}) {
        GiChoice choice = sweep.base;
        choice.specular = model;
        rows.push_back(measure.measure("shading", choice));
    }
    for (const DiffuseModel model : {DiffuseModel::Hill, DiffuseModel::Wang}) {
        GiChoice choice = sweep.base;
        choice.diffuse = model;
        rows.push_back(measure.measure("shading", choice));
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
                const GiMeasureSettings& settings)
{
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
    addRepresentations(measure, sweep, study.rows);
    addLobes(measure, sweep, study.rows);
    addDropped(measure, sweep, study.rows);
    addSizes(measure, sweep, study.rows);
    addShading(measure, sweep, study.rows);
    return study;
}

} // namespace strandlight
