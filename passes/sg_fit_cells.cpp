#include "passes/sg_fit_cells.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "shaders/shared/octahedral.h"
#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg_fit_types.h"

namespace strandlight {
namespace {

// Places are below 2^20 in x and y, charts below 2^24.
std::uint64_t keyOf(std::uint64_t x, std::uint64_t y, std::uint64_t chart)
{
    return (chart << 40) | (y << 20) | x;
}

// Four corners of each cell, one after the other.
std::vector<glm::uvec4> findCells(const std::vector<glm::uvec3>& places, const FitPlaces& texels)
{
    std::vector<glm::uvec4> cells;
    std::vector<bool> covered(places.size(), false);
    for (std::uint32_t t = 0; t < places.size(); ++t) {
        const auto at = [&, place = places[t]](int dx, int dy) {
            return texels.at(int(place.x) + dx, int(place.y) + dy, place.z);
        };
        const glm::uvec4 cell(t, at(1, 0), at(0, 1), at(1, 1));
        if (cell.y == gpu::kSgFitNone || cell.z == gpu::kSgFitNone || cell.w == gpu::kSgFitNone)
            continue;
        cells.push_back(cell);
        for (int c = 0; c < 4; ++c)
            covered[cell[c]] = true;
    }
    for (std::uint32_t t = 0; t < places.size(); ++t)
        if (!covered[t])
            cells.push_back(glm::uvec4(t));
    // By texel, so that neighbouring lanes read neighbouring words and chunks are short ranges of
    // texels.
    std::sort(cells.begin(), cells.end(),
              [](const glm::uvec4& a, const glm::uvec4& b) { return a.x < b.x; });
    return cells;
}

} // namespace

FitPlaces::FitPlaces(const std::vector<glm::uvec3>& places)
{
    texels_.reserve(places.size() * 2);
    for (std::size_t t = 0; t < places.size(); ++t)
        texels_.emplace(keyOf(places[t].x, places[t].y, places[t].z), std::uint32_t(t));
}

std::uint32_t FitPlaces::at(int x, int y, std::uint32_t chart) const
{
    if (x < 0 || y < 0)
        return gpu::kSgFitNone;
    const auto found = texels_.find(keyOf(std::uint64_t(x), std::uint64_t(y), chart));
    return found == texels_.end() ? gpu::kSgFitNone : found->second;
}

glm::uvec4 FitCells::cornersOf(std::uint32_t cell) const
{
    return {corners[cell], corners[cellCount + cell], corners[2 * std::size_t(cellCount) + cell],
            corners[3 * std::size_t(cellCount) + cell]};
}

FitCells buildFitCells(const Atlas& atlas)
{
    std::vector<glm::uvec3> places;
    places.reserve(atlas.texels.size());
    for (const AtlasTexel& texel : atlas.texels)
        places.emplace_back(texel.x, texel.y, texel.chart);
    return buildFitCells(std::move(places));
}

FitCells buildFitCells(std::vector<glm::uvec3> places)
{
    const FitPlaces texels(places);
    const std::vector<glm::uvec4> cells = findCells(places, texels);
    const std::size_t texelCount = places.size();
    FitCells out;
    out.texelCount = std::uint32_t(texelCount);
    out.cellCount = std::uint32_t(cells.size());
    out.corners.resize(4 * cells.size());
    out.gather.assign(4 * texelCount, gpu::kSgFitNone);
    out.neighbours.resize(4 * texelCount);
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        for (std::uint32_t c = 0; c < 4; ++c) {
            const std::uint32_t texel = cells[cell][int(c)];
            out.corners[c * cells.size() + cell] = texel;
            // A regular texel is corner c of at most one cell, an isolated one is all four of its
            // own.
            STRANDLIGHT_ASSERT_EQ(out.gather[c * texelCount + texel], gpu::kSgFitNone);
            out.gather[c * texelCount + texel] = std::uint32_t(cell) * 4 + c;
        }
    }
    const glm::ivec2 offsets[4] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    for (std::size_t t = 0; t < texelCount; ++t)
        for (std::size_t n = 0; n < 4; ++n)
            out.neighbours[n * texelCount + t] = texels.at(
                int(places[t].x) + offsets[n].x, int(places[t].y) + offsets[n].y, places[t].z);
    out.places = std::move(places);
    return out;
}

std::vector<glm::vec4> fitDirections(std::uint32_t size)
{
    std::vector<glm::vec4> directions;
    directions.reserve(std::size_t(size) * size);
    double total = 0.0;
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const glm::vec2 uv((float(x) + 0.5f) / float(size), (float(y) + 0.5f) / float(size));
            directions.emplace_back(gpu::hemiOctDecode(uv), gpu::hemiOctSolidAngle(x, y, size));
            total += double(directions.back().w);
        }
    }
    for (glm::vec4& d : directions)
        d.w = float(double(d.w) / total);
    return directions;
}

FitProblem buildFitProblem(const Atlas& atlas, const CpuLightfield& field, LightSet light,
                           const FitSettings& settings)
{
    const std::vector<std::uint32_t>& words =
        light == LightSet::Radiance ? field.radiance : field.environment;
    const std::size_t directions = std::size_t(field.size) * field.size;
    if (field.texelCount != atlas.texels.size() || words.size() != field.texelCount * directions ||
        field.valid.size() != field.texelCount)
        throw Error("fit: " + std::to_string(atlas.texels.size()) + " atlas texels but " +
                    std::to_string(field.texelCount) + " images of " + std::to_string(directions) +
                    " directions in " + std::to_string(words.size()) + " words");
    if (settings.lobes < 1 || settings.lobes > 32)
        throw Error("fit: " + std::to_string(settings.lobes) + " lobes; 1 to 32 are possible");

    FitProblem problem;
    problem.cells = buildFitCells(atlas);
    problem.tiles = lobeTiles(atlas, std::max(settings.lobeTile, 1u));
    problem.lobes = settings.lobes;
    problem.size = field.size;
    problem.directions = fitDirections(field.size);
    // Broad enough for constant light; a lobe narrower than a cell of the image cannot be seen.
    problem.minimumLogSharpness = -4.0f;
    problem.maximumLogSharpness = std::log(float(directions));

    // Transpose, and mean radiance per texel.
    const std::size_t texelCount = field.texelCount;
    problem.images.resize(words.size());
    problem.scales.resize(texelCount);
    double total = 0.0;
    for (std::size_t t = 0; t < texelCount; ++t) {
        double mean = 0.0;
        for (std::size_t d = 0; d < directions; ++d) {
            const std::uint32_t word = words[t * directions + d];
            problem.images[d * texelCount + t] = word;
            const glm::vec3 radiance = gpu::unpackRgb9e5(word);
            mean += double(radiance.x + radiance.y + radiance.z) / 3.0 *
                    double(problem.directions[d].w);
        }
        problem.scales[t] = field.valid[t] != 0 ? float(mean) : 0.0f;
        total += double(problem.scales[t]);
    }

    // A floor, so that a black texel has a scale; a texel without image gets the global mean.
    const double globalMean = total > 0.0 ? total / double(texelCount) : 1.0;
    const float floor = float(1.0e-3 * globalMean);
    for (std::size_t t = 0; t < texelCount; ++t) {
        if (field.valid[t] == 0) {
            problem.scales[t] = -float(globalMean);
        } else if (problem.scales[t] < floor) {
            problem.scales[t] = floor;
            ++problem.raisedScales;
        }
    }
    return problem;
}

double fitLearningRate(const FitSettings& settings, std::uint32_t step)
{
    const double progress = (double(step) + 1.0) / double(std::max(settings.steps, 1u));
    return double(settings.learningRate) * std::min(1.0, 2.0 * (1.0 - progress));
}

double fitSmoothness(const FitSettings& settings, std::uint32_t step)
{
    if (!(settings.smoothness > 0.0f) || settings.coarseSmoothness <= settings.smoothness)
        return double(settings.smoothness);
    const double progress =
        std::min(1.0, double(step) / (0.7 * double(std::max(settings.steps, 1u))));
    return double(settings.coarseSmoothness) *
           std::pow(double(settings.smoothness) / double(settings.coarseSmoothness), progress);
}

std::uint32_t fitDirectionsPerStep(const FitSettings& settings, std::uint32_t directionCount)
{
    std::uint32_t count = std::clamp(settings.directionsPerStep, 1u, directionCount);
    while (directionCount % count != 0)
        --count;
    return count;
}

} // namespace strandlight
