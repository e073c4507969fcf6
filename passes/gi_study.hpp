// Run time and bytes against error, for baked global illumination: every knob turned about a base,
// one at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "passes/gi_measure.hpp"

namespace strandlight {

// Ways to keep a light field, and lobes by storage, are measured with every lobe kept; the other
// knobs turn about the base.
struct GiSweep
{
    GiChoice base;
    std::vector<std::string> fits{"direct", "cnn", "cnn+refine"};
    std::vector<std::uint32_t> fixedLobes{5, 9, 12, 24};
    std::vector<std::uint32_t> lobes{2, 4, 6, 7, 8, 12, 16, 24}; // each in every storage
    std::vector<float> lobeErrors{0.05f, 0.12f, 0.14f, 0.2f};    // of lobes that are dropped
    std::vector<std::uint32_t> atlases{32, 64, 96, 128, 192, 256};
    std::vector<std::uint32_t> lightfields{8, 12, 16, 24, 32};
    std::vector<std::uint32_t> samples{1, 2, 4, 8, 16, 32};
};

GiSweep smallGiSweep();             // of minutes, about an atlas of 56
GiMeasureSettings smallGiMeasure(); // the pictures and truths that go with it

struct GiStudy
{
    std::vector<GiRow> rows; // the first is the base
    std::vector<GiTracePoint> traces;
    CpuImage picture; // of the base
    CpuImage truth;
    FrameResult frame; // passes and what was skipped, of the base
    BakeSavings savings;
};

// Is told after every row; `study` has the rows and traces so far.
using GiStudyWatch = std::function<void(const GiStudy& study)>;

// Throws Interrupted when the user stops, Error when the scene cannot be baked.
GiStudy studyGi(Context& context, const Scene& scene, const GiSweep& sweep,
                const GiMeasureSettings& settings, const GiStudyWatch& watch = {});

} // namespace strandlight
