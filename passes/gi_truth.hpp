// The path-traced picture of a study, kept on disk between runs.
#pragma once

#include <filesystem>

#include "engine/base/image.hpp"
#include "passes/path_trace.hpp"

namespace strandlight {

// From `folder`/truth_<hash of scene, camera and settings>.exr when it is there, else traced and,
// unless `folder` is empty, written there. Throws as renderReference() and the file functions do.
CpuImage truthPicture(Context& context, const Scene& scene, GpuScene& device, const Camera& camera,
                      const ReferenceSettings& settings, const std::filesystem::path& folder);

} // namespace strandlight
