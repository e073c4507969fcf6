// What a capture holds between its steps; only the sources of LightfieldCapture include this.
#pragma once

#include "passes/lightfield_capture.hpp"
#include "passes/slice_planner.hpp"

namespace strandlight {

struct LightfieldCapture::State
{
    State(Context& c, GpuScene& s, const CaptureSettings& set)
        : context(c), scene(s), settings(set), planner(set.cellsPerDispatch)
    {
    }

    void captureSlice(std::uint32_t first, std::uint32_t count);
    void traceRange(std::uint32_t firstTexel, std::uint32_t firstCell, std::uint32_t count);
    void packSlice(LightfieldPart& part, std::uint32_t first, std::uint32_t count);
    void markInvalid(const LightfieldPart& part, std::uint32_t first, std::uint32_t count);
    LightfieldPart& partOf(std::uint32_t texel);
    std::uint32_t identity() const;

    Context& context;
    GpuScene& scene;
    CaptureSettings settings;
    SlicePlanner planner;
    TraceStatistics statistics;
    std::uint32_t pointsCrc = 0;
    Buffer points;      // CapturePoint [texelCount]
    Buffer accumulator; // vec4 [kSliceCells or one texel, 2]
    Buffer counters;    // uint [kTraceCounters]
    Buffer primaries;   // uint [texels of a slice, kPrimaryKinds]
    Lightfield field;
    std::uint32_t completed = 0;
    std::uint32_t sliceTexels = 1;
};

} // namespace strandlight
