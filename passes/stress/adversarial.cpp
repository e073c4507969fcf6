// Fits of light fields that are made to break them: they must end finite, with every clamp counted.
#include <array>
#include <cmath>
#include <string>

#include "passes/sg_fit.hpp"
#include "passes/stress/inputs.hpp"
#include "passes/stress/kernel_inputs.hpp"
#include "passes/stress/tally.hpp"
#include "shaders/shared/rgb9e5.h"

namespace strandlight {

namespace {

constexpr std::uint32_t kGrid = 4; // texels per side
constexpr std::uint32_t kSize = 8; // directions per side

Atlas smallAtlas()
{
    Atlas atlas;
    atlas.resolution = kGrid;
    atlas.chartCount = 1;
    for (std::uint32_t i = 0; i < kGrid * kGrid; ++i) {
        AtlasTexel texel{};
        texel.x = i % kGrid;
        texel.y = i / kGrid;
        atlas.texels.push_back(texel);
    }
    return atlas;
}

enum class Adversary
{
    BrightTexel,  // one direction of one texel at 1e6, the others near 1
    Black,        // nothing anywhere
    Checkerboard, // 0 and 1000 in turn, over directions and texels
    Sun           // one direction at 6e4, a faint sky
};
constexpr std::array<const char*, 4> kNames = {"a single 1e6 texel", "all black", "checkerboard",
                                               "one-texel sun"};

float radianceOf(Adversary kind, std::uint32_t texel, std::uint32_t direction, StressRandom& r)
{
    const std::uint32_t x = direction % kSize, y = direction / kSize;
    switch (kind) {
    case Adversary::BrightTexel:
        return texel == 5 && direction == 27 ? 1e6f : r.uniform(0.5f, 1.5f);
    case Adversary::Black:
        return 0.0f;
    case Adversary::Checkerboard:
        return (x + y + texel) % 2 ? 1000.0f : 0.0f;
    case Adversary::Sun:
        return direction == 20 ? 6e4f : r.uniform(0.0f, 0.01f);
    }
    return 0.0f;
}

struct AdversaryField
{
    CpuLightfield field;
    std::uint64_t clampedCells = 0;
};

AdversaryField fieldOf(Adversary kind, std::uint32_t seed)
{
    AdversaryField result;
    CpuLightfield& field = result.field;
    field.size = kSize;
    field.texelCount = kGrid * kGrid;
    field.valid.assign(field.texelCount, 1);
    for (std::uint32_t t = 0; t < field.texelCount; ++t)
        for (std::uint32_t d = 0; d < kSize * kSize; ++d) {
            StressRandom r(seed, t * kSize * kSize + d);
            const glm::vec3 radiance(radianceOf(kind, t, d, r));
            result.clampedCells += gpu::rgb9e5Clamps(radiance) ? 1 : 0;
            field.radiance.push_back(gpu::packRgb9e5(radiance));
        }
    return result;
}

StressRow stressFit(Context& context, FitMode mode, Adversary kind, const StressSettings& s)
{
    const AdversaryField adversary = fieldOf(kind, s.seed + 110);
    FitSettings settings;
    settings.mode = mode;
    settings.lobes = 4;
    settings.steps = settings.cnnSteps = s.steps;
    settings.seed = s.seed;
    const FitProblem problem =
        buildFitProblem(smallAtlas(), adversary.field, LightSet::Radiance, settings);
    FitStatistics statistics;
    const SgField lobes = fitLobes(context, problem, settings, &statistics);

    const std::string name = std::string(toString(mode)) + ", " + kNames[std::size_t(kind)];
    Tally finite(name, 0.0, "finite lobes and losses");
    for (std::size_t i = 0; i < lobes.lobes.size(); ++i) {
        const SgLobe& lobe = lobes.lobes[i];
        const auto text = [&] { return "lobe " + std::to_string(i); };
        finite.bound(double(glm::length(lobe.axis)), 0.999, 1.001, text);
        finite.bound(double(lobe.logSharpness), -16.0, 16.0, text);
        for (int c = 0; c < 3; ++c)
            finite.bound(double(lobe.amplitude[c]), 0.0, 1e12, text);
    }
    const auto text = [&] { return "loss " + numberText(statistics.lastLoss); };
    finite.bound(statistics.firstLoss, 0.0, 1e30, text);
    finite.bound(statistics.lastLoss, 0.0, 1e30, text);
    // What the fit says that it held at a limit, left out or raised.
    finite.clamped(adversary.clampedCells + statistics.sharpnessAtLimit +
                   statistics.amplitudesAtZero + statistics.raisedScales +
                   statistics.heldIrradiance + statistics.skippedSteps);
    // Clamps are there to be seen: the packing's in the first field, the dark texels' in the
    // second.
    if (kind == Adversary::BrightTexel)
        finite.require(adversary.clampedCells == 1, text);
    if (kind == Adversary::Black)
        finite.require(statistics.raisedScales == problem.texelCount(), text);
    return finite.row();
}

} // namespace

std::vector<StressRow> stressAdversaries(Context& context, const StressSettings& settings)
{
    std::vector<StressRow> rows;
    for (const FitMode mode : {FitMode::Direct, FitMode::Cnn})
        for (const Adversary kind :
             {Adversary::BrightTexel, Adversary::Black, Adversary::Checkerboard, Adversary::Sun})
            rows.push_back(stressFit(context, mode, kind, settings));
    return rows;
}

} // namespace strandlight
