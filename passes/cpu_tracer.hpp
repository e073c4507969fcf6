// The path tracer once more, on the CPU and written for the reader: the judge of
// shaders/lib/path.glsl. It draws the same random numbers, so a picture of few samples agrees pixel
// by pixel.
#pragma once

#include "engine/base/image.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "engine/scene/scene.hpp"
#include "passes/path_trace.hpp"

namespace strandlight {

// Radiance, alpha 1. One thread; for tests and tiny pictures.
CpuImage renderOnCpu(const Scene& scene, const Camera& camera, const ReferenceSettings& settings);

} // namespace strandlight
