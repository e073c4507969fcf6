// Fills light field images by path tracing, slice by slice; can be stopped and taken up again.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/scene/atlas.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "engine/scene/scene.hpp"
#include "passes/capture_points.hpp"
#include "passes/lightfield.hpp"
#include "passes/path_trace.hpp"

namespace strandlight {

struct CaptureSettings
{
    std::uint32_t size = 16;               // cells per side of an image
    std::uint32_t samplesPerDirection = 8; // paths per cell, spread evenly over it
    std::uint32_t bounces = 6;             // reflections after the primary ray
    std::uint32_t seed = 1;
    std::uint32_t cellsPerDispatch = 0; // 0: chosen from measured time; results do not depend on it
};

// What LightfieldCapture allocates.
std::uint64_t lightfieldCaptureBytes(std::uint64_t texels, std::uint32_t size, bool environment);

class LightfieldCapture
{
public:
    // `scene` is borrowed and must outlive the capture. Throws Error for a size of 0 or above 256
    // or no samples.
    LightfieldCapture(Context& context, GpuScene& scene, std::vector<gpu::CapturePoint> points,
                      const CaptureSettings& settings);
    ~LightfieldCapture();

    // Captures the next texels, up to a few seconds of work; true when all are done. Throws
    // Interrupted between dispatches; what earlier steps finished stays.
    bool step();
    std::uint32_t completedTexels() const;
    std::uint32_t texelCount() const;
    const TraceStatistics& statistics() const;

    // Everything that is finished so far. restore() takes bytes that save() of a capture with the
    // same points, settings and scene features made and goes on from there, to the same result;
    // throws FileError otherwise.
    std::vector<std::uint8_t> save() const;
    void restore(std::span<const std::uint8_t> bytes);

    // The light field; the capture is empty afterwards. Asserts that all steps are done.
    Lightfield finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

// All of it with progress shown.
Lightfield captureLightfield(Context& context, const Scene& scene, GpuScene& device,
                             const Atlas& atlas, const CaptureSettings& settings,
                             TraceStatistics* statistics = nullptr);

} // namespace strandlight
