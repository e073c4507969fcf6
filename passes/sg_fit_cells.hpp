// The direct SG fit as plain arrays: which texels are interpolated together, what each of them saw,
// where to start. Shared by the kernels (passes/sg_fit.cpp) and their CPU twin
// (passes/sg_fit_reference.cpp).
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/atlas.hpp"
#include "passes/lightfield.hpp"
#include "passes/sg_field.hpp"
#include "passes/sg_fit_settings.hpp"

namespace strandlight {

// 2 x 2 blocks of covered texels of one chart: where shading interpolates. A texel without such a
// block gets a cell of its own with four equal corners.
struct FitCells
{
    std::uint32_t texelCount = 0;
    std::uint32_t cellCount = 0;
    std::vector<glm::uvec3> places;     // [texel] x, y, chart
    std::vector<std::uint32_t> corners; // [4, cell] texel; corner 1 is +x, corner 2 is +y
    std::vector<std::uint32_t> gather;  // [4, texel] cell * 4 + corner, or kSgFitNone
    std::vector<std::uint32_t>
        neighbours; // [4, texel] texel at -x, +x, -y, +y of the same chart, or kSgFitNone

    glm::uvec4 cornersOf(std::uint32_t cell) const;
};

FitCells buildFitCells(const Atlas& atlas);
// Of texels at these places: x, y, chart.
FitCells buildFitCells(std::vector<glm::uvec3> places);

// Texels by place.
class FitPlaces
{
public:
    explicit FitPlaces(const std::vector<glm::uvec3>& places);
    // The texel there, or kSgFitNone; a chart knows none outside itself.
    std::uint32_t at(int x, int y, std::uint32_t chart) const;

private:
    std::unordered_map<std::uint64_t, std::uint32_t> texels_;
};

// The directions of a hemi-octahedral image: unit vector, and its share of the hemisphere's solid
// angle.
std::vector<glm::vec4> fitDirections(std::uint32_t size);

struct FitProblem
{
    FitCells cells;
    std::uint32_t lobes = 0;
    std::uint32_t size = 0;            // of the images
    std::vector<glm::vec4> directions; // [direction]
    std::vector<std::uint32_t>
        images; // [direction, texel] RGB9E5: neighbouring lanes read neighbouring words
    std::vector<float> scales; // [texel] mean radiance over solid angle, negative: no image
    std::uint64_t raisedScales = 0;
    LobeTiles tiles;          // of settings.lobeTile
    std::vector<float> gloss; // [texel] texelGloss(), for lobes that are dropped; empty: 0
    float minimumLogSharpness = 0.0f;
    float maximumLogSharpness = 0.0f;

    std::uint32_t directionCount() const { return size * size; }
    std::uint32_t texelCount() const { return cells.texelCount; }
};

// Throws Error when light field, atlas and settings do not belong together, with the numbers.
FitProblem buildFitProblem(const Atlas& atlas, const CpuLightfield& field, LightSet light,
                           const FitSettings& settings);

// The common start of all texels; amplitudes follow each texel's mean radiance.
FitState startFit(const FitProblem& problem, FitStart start);
// The start from given lobes (the encoder's).
FitState startFit(const FitProblem& problem, const SgField& lobes);

SgField fieldFromState(const FitProblem& problem, const FitState& state);

// Learning rate of step 0, 1, ...: constant, then linear to zero.
double fitLearningRate(const FitSettings& settings, std::uint32_t step);
// The Laplacian weight of step 0, 1, ...
double fitSmoothness(const FitSettings& settings, std::uint32_t step);
// The largest divisor of `directionCount` that is at most settings.directionsPerStep.
std::uint32_t fitDirectionsPerStep(const FitSettings& settings, std::uint32_t directionCount);

} // namespace strandlight
