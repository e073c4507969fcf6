#include "passes/bake_memory.hpp"

#include <algorithm>

#include "engine/base/error.hpp"
#include "engine/graph/plan.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "passes/lightfield_capture.hpp"
#include "passes/sg_fit_cnn.hpp"
#include "passes/sg_fit_direct.hpp"

namespace strandlight {

namespace {

template <class T> std::uint64_t bytesOf(const std::vector<T>& values)
{
    return values.size() * sizeof(T);
}

std::uint64_t sceneBytes(const TracedScene& scene)
{
    return bytesOf(scene.bvh.nodes) + bytesOf(scene.bvh.triangles) + bytesOf(scene.corners) +
           bytesOf(scene.materials) + bytesOf(scene.lightTable) + bytesOf(scene.textures.words) +
           bytesOf(scene.lights) + bytesOf(scene.environment);
}

// Of the larger of the two light sets. What was kept is fitted in the same memory after the first
// fit.
std::uint64_t directBytes(const Context& context, const Atlas& atlas, const BakeSettings& settings,
                          std::uint32_t lobes)
{
    FitProblem problem;
    problem.cells = buildFitCells(atlas);
    problem.size = settings.lightfieldSize;
    problem.lobes = lobes;
    return directFitBytes(context, problem);
}

} // namespace

std::uint64_t BakeMemory::peakBytes() const
{
    return sceneBytes + std::max({captureBytes, encoderBytes, directBytes});
}

BakeMemory planBakeMemory(Context& context, const Scene& scene, const BakeSettings& settings)
{
    if (scene.triangles.empty())
        throw Error("the scene has no triangles: there is nothing to bake");
    const Atlas atlas = buildAtlas(scene, {.resolution = settings.atlasResolution});
    const bool environment = scene.environment.has_value();
    const std::uint32_t lobes =
        environment ? std::max(settings.lobes, settings.environmentLobes) : settings.lobes;

    BakeMemory memory;
    memory.sceneBytes = sceneBytes(prepareScene(scene));
    memory.captureBytes =
        lightfieldCaptureBytes(atlas.texels.size(), settings.lightfieldSize, environment);
    memory.text =
        memoryLine("scene", memory.sceneBytes) + memoryLine("capture", memory.captureBytes);
    TrainingMemory encoder;
    if (settings.fit != FitMode::Direct) {
        encoder = encoderTrainingMemory(context, settings.lightfieldSize, lobes);
        memory.encoderBytes = encoder.bytes();
        memory.text += memoryLine("encoder's training", memory.encoderBytes);
    }
    if (settings.fit != FitMode::Cnn) {
        memory.directBytes = directBytes(context, atlas, settings, lobes);
        memory.text += memoryLine("direct fit", memory.directBytes);
    }
    memory.text += memoryLine("at once, at most", memory.peakBytes());
    if (!encoder.text.empty())
        memory.text += "encoder, one training step\n" + encoder.text;
    return memory;
}

} // namespace strandlight
