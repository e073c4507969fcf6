// The thesis's way to lobes: one convolutional encoder, trained on all images of the scene, maps an
// image to its lobes; alike images give alike lobes, which is what makes them interpolate. Currius,
// Dolonius, Assarsson, Sintorn. Spherical Gaussian Light-field Textures for Fast Precomputed Global
// Illumination. 2020
#pragma once

#include "compute_nn/training_memory.hpp"
#include "engine/vk/context.hpp"
#include "passes/sg_field.hpp"
#include "passes/sg_fit_cells.hpp"
#include "passes/sg_fit_settings.hpp"
#include "passes/sg_fit_watch.hpp"

namespace strandlight {

// Trains the encoder for settings.cnnSteps steps on the texels with images, then encodes every
// texel. Texels without image get the mean of their neighbours. Fills firstLoss, lastLoss and
// skippedSteps of `statistics`. Deterministic. Throws Interrupted when the user stops.
SgField fitLobesByCnn(Context& context, const FitProblem& problem, const FitSettings& settings,
                      FitStatistics& statistics, FitWatch* watch = nullptr);

// What a training step of that encoder will allocate, for light-field images of `imageSize` a side.
TrainingMemory encoderTrainingMemory(Context& context, std::uint32_t imageSize,
                                     std::uint32_t lobes);

} // namespace strandlight
