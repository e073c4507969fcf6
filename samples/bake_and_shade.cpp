// The API in twenty lines: a scene, its baked light, a picture lit by it, and how far that is from
// the truth.
#include <cstdio>

#include "engine/base/image_io.hpp"
#include "engine/base/image_metrics.hpp"
#include "engine/scene/scene_loader.hpp"
#include "passes/bake.hpp"
#include "passes/path_trace.hpp"
#include "passes/render_frame.hpp"
#include "passes/sgl_file.hpp"

int main(int argc, char** argv)
{
    using namespace strandlight;
    Context device = Context::headless();
    const Scene scene = loadScene(argc > 1 ? argv[1] : "builtin:room");
    const Camera camera = defaultCamera(scene);

    const SgBake bake = bakeScene(device, scene, {.atlasResolution = 64, .steps = 200});
    saveSgl("bake_and_shade.sgl", bake);

    GpuScene onDevice = uploadScene(device, scene);
    const FrameResult frame =
        renderFrame(device, scene, onDevice, bake, camera, {.width = 320, .height = 240});
    savePng("bake_and_shade.png", frame.radiance);

    const CpuImage truth = renderReference(device, onDevice, camera, {.width = 320, .height = 240});
    std::printf("FLIP %.3f on %s\n", compareImages(frame.radiance, truth).flip,
                device.device().name.c_str());
}
