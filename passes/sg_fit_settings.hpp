// How lobes are fitted, and what a fit says about itself. Defaults are the measured best.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace strandlight {

enum class FitMode : std::uint32_t
{
    Direct,   // joint optimisation of all texels from a common start
    Cnn,      // the thesis: one convolutional encoder for the scene, image in, lobes out
    CnnRefine // the encoder's lobes as the start of the direct fit
};

const char* toString(FitMode mode);           // "direct", "cnn", "cnn+refine"
FitMode fitModeFrom(const std::string& name); // throws Error naming the choices

// Which light of the captured images the lobes stand for.
enum class LightSet : std::uint32_t
{
    Radiance,
    Environment
};

enum class FitStart : std::uint32_t
{
    Fibonacci, // evenly over the hemisphere, the same for every texel
    Clusters   // spherical k-means of all texels' images together, the same for every texel
};

struct FitSettings
{
    FitMode mode = FitMode::Direct;
    std::uint32_t lobes = 8;
    std::uint32_t steps = 200;            // of the direct fit's finest level; 300 gain 1 to 3 %
    std::uint32_t directionsPerStep = 64; // lowered to a divisor of the direction count
    float learningRate = 0.03f;           // falls linearly to zero over the second half
    FitStart start = FitStart::Fibonacci;
    float cornerFraction =
        0.3f; // of looks at texels; the others are between texels. 1: texels apart
    float peakSoftening =
        0.05f; // weight of a direction: 1 / (1 + s * radiance / mean); 0: plain squares
    // Laplacian over neighbouring texels of a chart: starts coarse, so that lobes find their places
    // together, and falls geometrically over the first 70 % of the steps. Against a constant 0.02
    // that lowers the error between texels by 2 to 3 %.
    float coarseSmoothness = 0.5f;
    float smoothness = 0.02f; // 0: none at any time
    // Coarse to fine (passes/sg_fit_coarse.hpp): how many times texels are joined to blocks of
    // 2 x 2, which are fitted first, each time with twice the steps; few texels take those steps
    // themselves. Against 600 steps of single texels, 2 levels lower the error between texels by 1
    // to 11 % in two thirds of the time; a third level is better on one scene, worse on another.
    std::uint32_t coarseLevels = 2;
    std::uint32_t cnnSteps = 600; // of the encoder, 512 texels each
    // Error-driven lobe count (passes/sg_prune.hpp): how much the fit's error may grow, as a
    // fraction. 0: every texel keeps all lobes.
    float lobeError = 0.0f;
    std::uint32_t lobeTile = 2;     // atlas texels a side that keep the same lobes
    std::uint32_t refitSteps = 300; // of those that are kept, in the direct modes
    std::uint32_t seed = 1;
};

struct FitStatistics
{
    double seconds = 0.0;
    double firstLoss = 0.0; // mean over cells, relative squared error per direction and channel
    double lastLoss = 0.0;
    std::uint64_t skippedSteps = 0;     // lobes whose gradient was not finite
    std::uint64_t sharpnessAtLimit = 0; // lobes that end at a limit of ln sharpness
    std::uint64_t amplitudesAtZero = 0; // lobes that end black
    std::uint64_t raisedScales = 0;     // texels so dark that the floor of the mean radiance holds
    std::uint64_t heldIrradiance = 0; // channels whose irradiance is off by more than a factor of 2
    std::uint64_t texelsWithoutImage = 0; // inside geometry: filled by their neighbours
    std::uint64_t lobesDropped = 0;
    std::uint64_t tiles = 0;     // of texels that keep the same lobes; 0: nothing was dropped
    std::uint64_t darkTiles = 0; // that keep none
};

// Everything that a direct fit needs to go on where it stopped, to the same bytes.
struct FitState
{
    std::uint32_t step = 0;
    std::vector<float> parameters;    // [lobe * 2 + half, texel, 4]; shaders/shared/sg_fit_types.h
    std::vector<float> firstMoments;  // the same
    std::vector<float> secondMoments; // [lobe, texel, 4]
    std::uint64_t skippedSteps = 0;
    double firstLoss = 0.0;
};

// For bakes that can be interrupted. `save` is called about every `secondsBetweenSaves` and before
// Interrupted is thrown; `resume` may be null.
struct FitCheckpoint
{
    const FitState* resume = nullptr;
    std::function<void(const FitState&)> save;
    double secondsBetweenSaves = 10.0;
};

} // namespace strandlight
