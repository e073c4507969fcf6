// From captured light-field images to lobes: the bake's second half.
// Currius, Dolonius, Assarsson, Sintorn. Spherical Gaussian Light-field Textures for Fast
// Precomputed Global Illumination. 2020 (the cnn mode) Green, Kautz, Durand. Efficient Reflectance
// and Visibility Approximations for Environment Map Rendering. 2007 (sums of Gaussians whose
// interpolated parameters are part of the fitting energy: the direct mode's ancestor)
#pragma once

#include "engine/scene/atlas.hpp"
#include "engine/vk/context.hpp"
#include "passes/lightfield.hpp"
#include "passes/sg_field.hpp"
#include "passes/sg_fit_cells.hpp"
#include "passes/sg_fit_settings.hpp"
#include "passes/sg_fit_watch.hpp"

namespace strandlight {

// Lobes [texel, lobe] for `light` of the captured images, by settings.mode. Deterministic: the same
// images, settings and seed give the same bytes. Throws Error when atlas and light field do not
// belong together or the problem does not fit the device, Interrupted (after checkpoint->save) when
// the user stops.
SgField fitLobes(Context& context, const Atlas& atlas, const Lightfield& lightfield, LightSet light,
                 const FitSettings& settings, FitStatistics* statistics = nullptr,
                 const FitCheckpoint* checkpoint = nullptr);

// The same from a problem on the CPU, when it is needed for a report as well.
SgField fitLobes(Context& context, const FitProblem& problem, const FitSettings& settings,
                 FitStatistics* statistics = nullptr, const FitCheckpoint* checkpoint = nullptr,
                 FitWatch* watch = nullptr);

} // namespace strandlight
