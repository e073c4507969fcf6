// The truth: pictures by path tracing on the device.
#pragma once

#include <cstdint>

#include "engine/base/image.hpp"
#include "engine/graph/render_graph.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "engine/scene/scene.hpp"
#include "engine/vk/context.hpp"

namespace strandlight {

struct ReferenceSettings
{
    std::uint32_t width = 320;
    std::uint32_t height = 240;
    std::uint32_t samples = 64; // per pixel, box filter
    std::uint32_t bounces = 16; // reflections; Russian roulette from the fifth
    std::uint32_t seed = 1;
    std::uint32_t pixelsPerDispatch =
        0; // 0: chosen from measured time; results do not depend on it
};

// What happened on the way. Lost rays and samples left out make a picture darker: they are
// reported, never hidden.
struct TraceStatistics
{
    std::uint64_t lostRays = 0; // rays that passed a bound of the traversal, paths out of budget
    std::uint64_t rejectedSamples = 0; // not finite
    std::uint32_t dispatches = 0;
    double seconds = 0.0;
    double slowestDispatchMs = 0.0;
};

// One dispatch: adds samples to `accumulator` (vec4 per pixel: sum of radiance, sample count; zero
// before the first) for a range of pixels until they have `targetSample` or their share of loop
// trips is used up. `counters` gets the numbers of path_types.h; counters[0] says how many pixels
// are not done. Returns the new accumulator version.
struct PathTraceRange
{
    std::uint32_t firstPixel = 0;
    std::uint32_t pixelCount = 0;
    std::uint32_t targetSample = 0;
};
struct PathTraceBuffers
{
    BufferId accumulator; // vec4 [height, width]
    BufferId counters;    // uint [kTraceCounters]
};
PathTraceBuffers addPathTracePass(RenderGraph& graph, GpuScene& scene, const Camera& camera,
                                  const ReferenceSettings& settings, const PathTraceRange& range,
                                  PathTraceBuffers buffers);

// Radiance, alpha 1. Shows progress; throws Interrupted when the user asks to stop, Error for an
// empty picture.
CpuImage renderReference(Context& context, const Scene& scene, const Camera& camera,
                         const ReferenceSettings& settings, TraceStatistics* statistics = nullptr);
// The same with a scene that is on the device already.
CpuImage renderReference(Context& context, GpuScene& scene, const Camera& camera,
                         const ReferenceSettings& settings, TraceStatistics* statistics = nullptr);

} // namespace strandlight
