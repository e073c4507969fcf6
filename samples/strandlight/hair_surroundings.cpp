#include "samples/strandlight/hair_surroundings.hpp"

#include "engine/base/error.hpp"
#include "engine/scene/environment.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "engine/scene/hair_head.hpp"
#include "engine/scene/scene_loader.hpp"
#include "passes/hair_distant.hpp"
#include "passes/hair_lights.hpp"
#include "passes/render_frame.hpp"
#include "samples/strandlight/open_bake.hpp"

namespace strandlight::cli {

HairSurroundings openSurroundings(const HairOptions& o, const HairStrands& hair)
{
    if (!o.bake.empty() && o.scene.empty())
        throw Error("--bake: needs the --scene it was made of");
    HairSurroundings around;
    if (!o.scene.empty())
        around.opaque = loadScene(o.scene);
    else if (isGroom(o))
        around.opaque = headScene();
    if (!o.environment.empty()) {
        if (!around.opaque)
            around.opaque.emplace();
        if (o.scene.empty())
            around.opaque->lights.clear();
        around.opaque->environment = loadEnvironment(o.environment);
    }
    if (!o.bake.empty()) {
        around.bake = openBake(o.bake, *around.opaque);
        const HairSphere sphere = boundingSphere(hair);
        around.distant = fitDistantLight(
            lightFieldAt(*around.opaque, *around.bake, sphere.centre, sphere.radius));
        around.distant->local = true;
    } else if (around.opaque && around.opaque->environment) {
        around.distant = fitDistantLight(*around.opaque->environment);
    }
    return around;
}

CpuImage renderBehind(Context& context, const HairSurroundings& around, const Camera& camera,
                      const HairRenderSettings& settings, HairFrame& record)
{
    const Scene& scene = *around.opaque;
    GpuScene gpuScene = uploadScene(context, scene);
    FrameResult frame = renderFrame(context, scene, gpuScene, *around.bake, camera,
                                    {.width = settings.width, .height = settings.height});
    record.timings.insert(record.timings.begin(), frame.timings.begin(), frame.timings.end());
    record.skipped.insert(record.skipped.begin(), frame.skipped.begin(), frame.skipped.end());
    return std::move(frame.radiance);
}

} // namespace strandlight::cli
