// One way to bake and shade a scene, measured: what it costs and how far it is from the truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/image.hpp"
#include "passes/gi_fits.hpp"
#include "passes/savings.hpp"

namespace strandlight {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

struct GiRow
{
    std::string knob; // what this row changes
    GiChoice choice;
    std::uint32_t texels = 0;   // with surface
    double bytesPerTexel = 0.0; // of the radiance, as stored
    double captureSeconds = 0.0;
    double fitSeconds = 0.0;                   // of the radiance
    double bakeSeconds = 0.0;                  // atlas, capture and all fits
    double shadingMilliseconds = kNotMeasured; // of the passes that read lobes, median frame
    double texelRmse = 0.0;       // radiance, at texels, against the images that were fitted
    double betweenRmse = 0.0;     // between texels, against a truth of its own paths
    double relMse = kNotMeasured; // of the picture against its path-traced truth
    double flip = kNotMeasured;
    double ssim = kNotMeasured;
};

struct GiMeasureSettings
{
    GiFitSettings fit;
    std::optional<Camera> camera; // none: the scene's default
    std::uint32_t width = 320, height = 240;
    std::uint32_t frames = 5;         // that are timed, after one that is not
    std::uint32_t truthSamples = 256; // paths per pixel
    std::filesystem::path cache;      // folder for truth pictures; empty: none
};

// Captures, fits and truths are made once and kept. All throw Interrupted when the user stops and
// Error when the scene or a choice cannot be baked.
class GiMeasure
{
public:
    // Borrows scene and context. The truth picture is made here, or read from the cache.
    GiMeasure(Context& context, const Scene& scene, const GiMeasureSettings& settings);
    ~GiMeasure();

    // Rows with the same capture and fit share them, seconds included.
    GiRow measure(const std::string& knob, const GiChoice& choice);
    // Error over time of this choice's fit, which is made now and kept for measure(). The encoder's
    // lobes, once there, are where "cnn+refine" goes on: its time contains theirs.
    std::vector<GiTracePoint> trace(const GiChoice& choice);

    const CpuImage& truth() const;
    const FrameResult& lastFrame() const; // of the last measured choice that can be drawn
    const BakeSavings& lastSavings() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace strandlight
