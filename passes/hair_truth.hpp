// Supersampled truths of hair, kept as files: they take minutes and do not change.
#pragma once

#include <filesystem>

#include "passes/hair_render.hpp"

namespace strandlight {

// renderHair of a reference without distant light or background picture. With a `folder` it comes
// from there when a sound file fits strands, triangles, camera, settings, device and kernels (then
// without timings), and is kept there when not. A folder that cannot be written costs the next
// run's time, nothing else. Throws what renderHair throws, and Error for other settings.
HairFrame hairTruth(Context& context, const HairStrands& hair, const Scene* opaque,
                    const Camera& camera, const HairRenderSettings& settings,
                    const std::filesystem::path& folder);

} // namespace strandlight
