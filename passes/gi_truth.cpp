#include "passes/gi_truth.hpp"

#include <cinttypes>
#include <cstdio>

#include "engine/base/fnv1a.hpp"
#include "engine/base/image_io.hpp"
#include "passes/bake_identity.hpp"

namespace strandlight {

CpuImage truthPicture(Context& context, const Scene& scene, GpuScene& device, const Camera& camera,
                      const ReferenceSettings& settings, const std::filesystem::path& folder)
{
    Fnv1a hash;
    hash.value(hashScene(scene));
    hash.value(camera); // floats without padding
    for (const std::uint32_t v :
         {settings.width, settings.height, settings.samples, settings.bounces, settings.seed})
        hash.value(v);
    char name[40];
    std::snprintf(name, sizeof name, "truth_%016" PRIx64 ".exr", hash.result());
    const std::filesystem::path path = folder / name;
    if (!folder.empty() && std::filesystem::exists(path))
        return loadImage(path);
    CpuImage truth = renderReference(context, device, camera, settings);
    if (!folder.empty())
        saveExr(path, truth);
    return truth;
}

} // namespace strandlight
