// The truth between texels: where light is captured that no fit has seen.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/atlas.hpp"
#include "engine/scene/scene.hpp"
#include "engine/vk/context.hpp"
#include "passes/fit_report.hpp"
#include "passes/lightfield_capture.hpp"

namespace strandlight {

// Images at places of an atlas, with progress shown under `title`. Throws Interrupted when the user
// stops.
CpuLightfield captureTexels(Context& context, const Scene& scene, GpuScene& device,
                            const Atlas& atlas, const std::vector<AtlasTexel>& places,
                            const CaptureSettings& settings, const char* title);

// Where a probe lies on the surface: the atlas place in the middle of its four texels. Probes whose
// middle is off every triangle of their chart, as on a ragged border, are removed.
std::vector<AtlasTexel> locateProbes(const Atlas& atlas, FitProbes& probes);

// At most `count` probes in the middle of four texels, with images; those inside geometry are left
// out. Throws Error when there is none.
FitProbes captureProbes(Context& context, const Scene& scene, GpuScene& device, const Atlas& atlas,
                        const FitProblem& problem, std::uint32_t count,
                        const CaptureSettings& settings);

} // namespace strandlight
