// Captures and fits of a study's choices, each made once and kept.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/gpu_scene.hpp"
#include "passes/fit_report.hpp"
#include "passes/gi_choice.hpp"

namespace strandlight {

// What one atlas saw.
struct GiCapture
{
    Atlas atlas;
    FitProblem problem; // of the radiance
    std::optional<SgField> environment;
    double captureSeconds = 0.0;     // with the atlas
    double environmentSeconds = 0.0; // of its fit
};

// What is true between the texels of an atlas.
struct GiBetween
{
    FitProbes probes;
    FitProblem view; // the atlas's cells and the probes' directions, no image of a texel

    double rmse(const LightFieldModel& model) const; // a model of `view`, or of its directions
};

// How the error between texels falls while a fit works.
struct GiTracePoint
{
    std::string fit;
    double seconds = 0.0;
    double betweenRmse = 0.0;
};

struct GiFitSettings
{
    BakeSettings bake; // bounces, steps, seed, environment lobes; the rest is each choice's
    std::uint32_t probes = 512;      // points between texels, at most
    std::uint32_t probeSize = 16;    // directions per side of their images
    std::uint32_t probeSamples = 64; // paths per direction
};

class GiFits
{
public:
    GiFits(Context& context, const Scene& scene, GpuScene& device, const GiFitSettings& settings)
        : context_(context), scene_(scene), device_(device), settings_(settings)
    {
    }

    const GiCapture& captured(const GiChoice& choice);
    const GiBetween& between(const GiChoice& choice);
    // The model's `seconds` are those of its making. With `trace`: made anew, after a warm-up.
    const LightFieldModel& fitted(const GiChoice& choice,
                                  std::vector<GiTracePoint>* trace = nullptr);

private:
    LightFieldModel fitFree(const GiChoice& choice, std::vector<GiTracePoint>* trace);

    Context& context_;
    const Scene& scene_;
    GpuScene& device_;
    GiFitSettings settings_;
    std::map<std::string, GiCapture> captures_; // by atlas, light field, samples
    std::map<std::string, GiBetween> betweens_; // by atlas
    std::map<std::string, LightFieldModel> fits_;
};

} // namespace strandlight
