// One capture, every way to keep it: the table of `strandlight fits`.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/vk/context.hpp"
#include "passes/fit_report.hpp"
#include "passes/lightfield_capture.hpp"
#include "passes/sg_fit_settings.hpp"

namespace strandlight {

struct FitStudySettings
{
    std::uint32_t atlasResolution = 48;
    CaptureSettings capture{.samplesPerDirection = 16}; // noise counts as error in every row
    FitSettings fit;                                    // of all free-lobe modes but `mode`
    std::uint32_t probes = 512;                         // points between texels, at most
    std::vector<FitMode> modes{FitMode::Cnn, FitMode::Direct, FitMode::CnnRefine};
    std::vector<float>
        lobeErrors; // the direct fit again, with lobes dropped (FitSettings::lobeError)
};

// Captures the radiance of a scene at its texels and at points in the middle of four texels, where
// no fit has looked. Rows: raw images, SH L1, SH L2, fixed-direction SGs, then `modes`, then
// `lobeErrors`. Throws Error on a scene that cannot be captured, Interrupted when the user stops.
FitReport studyFits(Context& context, const Scene& scene, const FitStudySettings& settings);

} // namespace strandlight
