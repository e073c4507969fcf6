#include "passes/path_trace.hpp"

#include <chrono>
#include <string>
#include <vector>

#include "engine/base/error.hpp"
#include "engine/base/log.hpp"
#include "engine/base/progress.hpp"
#include "engine/scene/camera.hpp"
#include "kernels/trace.gen.hpp"
#include "passes/slice_planner.hpp"
#include "shaders/shared/path_types.h"

namespace strandlight {
namespace {

double millisecondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

CpuImage normalise(const std::vector<glm::vec4>& sums, const ReferenceSettings& settings)
{
    CpuImage image(settings.width, settings.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = glm::vec4(glm::vec3(sums[i]) / sums[i].w, 1.0f);
    return image;
}

} // namespace

PathTraceBuffers addPathTracePass(RenderGraph& graph, GpuScene& scene, const Camera& camera,
                                  const ReferenceSettings& settings, const PathTraceRange& range,
                                  PathTraceBuffers buffers)
{
    gpu::PathTracePush push{};
    push.grid = scene.grid;
    push.camera = cameraRays(camera, settings.width, settings.height);
    push.triangleCount = scene.triangleCount;
    push.width = settings.width;
    push.firstPixel = range.firstPixel;
    push.pixelCount = range.pixelCount;
    push.targetSample = range.targetSample;
    push.seed = settings.seed;
    push.bounces = settings.bounces;

    PassBuilder clear = graph.addTransferPass("clear trace counters");
    buffers.counters = clear.write(buffers.counters);
    clear.fill(buffers.counters, 0);

    PassBuilder pass = graph.addComputePass("path trace");
    const auto import = [&](Buffer& buffer) {
        return pass.read(graph.importBuffer(scene.orDummy(buffer)));
    };
    buffers.accumulator = pass.write(buffers.accumulator);
    buffers.counters = pass.write(buffers.counters);
    pass.dispatch(kernels::path_trace, {range.pixelCount, 1, 1}, push,
                  {buffers.accumulator, buffers.counters, import(scene.nodes),
                   import(scene.triangles), import(scene.corners), import(scene.materials),
                   import(scene.lightTable), import(scene.textures), import(scene.environment),
                   import(scene.lights)},
                  {scene.features});
    return buffers;
}

CpuImage renderReference(Context& context, GpuScene& scene, const Camera& camera,
                         const ReferenceSettings& settings, TraceStatistics* statistics)
{
    if (settings.width == 0 || settings.height == 0 || settings.samples == 0)
        throw Error("reference of " + std::to_string(settings.width) + "x" +
                    std::to_string(settings.height) + " pixels with " +
                    std::to_string(settings.samples) + " samples");
    const auto start = std::chrono::steady_clock::now();
    const std::uint32_t pixels = settings.width * settings.height;
    Buffer accumulator(context, std::uint64_t(pixels) * sizeof(glm::vec4), "accumulator");
    Buffer counters(context, gpu::kTraceCounters * sizeof(std::uint32_t), "trace counters");
    TraceStatistics totals;
    SlicePlanner planner(settings.pixelsPerDispatch);
    Progress progress("reference", pixels);

    std::uint32_t first = 0;
    while (first < pixels) {
        throwIfInterrupted();
        const std::uint32_t count = std::min(planner.items(), pixels - first);
        std::uint32_t unfinished = count;
        while (unfinished > 0) {
            const auto before = std::chrono::steady_clock::now();
            RenderGraph graph(context);
            addPathTracePass(graph, scene, camera, settings, {first, count, settings.samples},
                             {graph.importBuffer(accumulator), graph.importBuffer(counters)});
            graph.run();
            planner.finished(count, millisecondsSince(before));
            const auto numbers = counters.downloadAs<std::uint32_t>();
            unfinished = numbers[0];
            totals.lostRays += numbers[1];
            totals.rejectedSamples += numbers[2];
            ++totals.dispatches;
            throwIfInterrupted();
        }
        first += count;
        progress.update(first);
    }
    totals.seconds = millisecondsSince(start) / 1000.0;
    totals.slowestDispatchMs = planner.slowestMs();
    if (totals.lostRays > 0 || totals.rejectedSamples > 0)
        logWarning("reference: " + std::to_string(totals.lostRays) + " rays gave up, " +
                   std::to_string(totals.rejectedSamples) + " samples were not finite");
    if (statistics != nullptr)
        *statistics = totals;
    return normalise(accumulator.downloadAs<glm::vec4>(), settings);
}

CpuImage renderReference(Context& context, const Scene& scene, const Camera& camera,
                         const ReferenceSettings& settings, TraceStatistics* statistics)
{
    GpuScene device = uploadScene(context, scene);
    return renderReference(context, device, camera, settings, statistics);
}

} // namespace strandlight
