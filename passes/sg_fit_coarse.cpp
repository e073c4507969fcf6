#include "passes/sg_fit_coarse.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg.h"
#include "shaders/shared/sg_fit_types.h"

namespace strandlight {
namespace {

constexpr std::uint32_t kSide = 2;

struct Blocks
{
    std::vector<glm::uvec3> places;     // [block] x, y, chart
    std::vector<std::uint32_t> ofTexel; // [texel]
};

Blocks findBlocks(const std::vector<glm::uvec3>& places)
{
    Blocks blocks;
    for (const glm::uvec3& place : places)
        blocks.places.emplace_back(place.x / kSide, place.y / kSide, place.z);
    std::vector<glm::uvec3> all = blocks.places;
    const auto before = [](const glm::uvec3& a, const glm::uvec3& b) {
        return a.y != b.y ? a.y < b.y : a.x != b.x ? a.x < b.x : a.z < b.z;
    };
    std::sort(all.begin(), all.end(), before);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    const FitPlaces known(all);
    for (const glm::uvec3& place : blocks.places)
        blocks.ofTexel.push_back(known.at(int(place.x), int(place.y), place.z));
    blocks.places = std::move(all);
    return blocks;
}

// Mean over the texels with an image; where there is none, what their scales say.
void averageImages(const FitProblem& fine, const Blocks& blocks, FitProblem& coarse)
{
    const std::size_t count = blocks.places.size(), texels = fine.texelCount();
    std::vector<double> seen(count, 0.0), scales(count, 0.0), without(count, 0.0);
    for (std::size_t t = 0; t < texels; ++t) {
        const std::uint32_t block = blocks.ofTexel[t];
        seen[block] += fine.scales[t] > 0.0f ? 1.0 : 0.0;
        scales[block] += std::max(double(fine.scales[t]), 0.0);
        without[block] = std::min(without[block], double(fine.scales[t]));
    }
    coarse.scales.resize(count);
    for (std::size_t b = 0; b < count; ++b)
        coarse.scales[b] = float(seen[b] > 0.0 ? scales[b] / seen[b] : without[b]);
    coarse.images.resize(count * fine.directionCount());
    std::vector<glm::vec3> sums(count);
    for (std::size_t d = 0; d < fine.directionCount(); ++d) {
        std::fill(sums.begin(), sums.end(), glm::vec3(0.0f));
        for (std::size_t t = 0; t < texels; ++t)
            if (fine.scales[t] > 0.0f)
                sums[blocks.ofTexel[t]] += gpu::unpackRgb9e5(fine.images[d * texels + t]);
        for (std::size_t b = 0; b < count; ++b)
            coarse.images[d * count + b] = gpu::packRgb9e5(sums[b] / float(std::max(seen[b], 1.0)));
    }
}

SgLobe weighted(const SgLobe& lobe, float weight, float inverseScale)
{
    return {lobe.axis * weight, lobe.logSharpness * weight,
            lobe.amplitude * (weight * inverseScale)};
}

} // namespace

CoarseProblem coarsen(const FitProblem& fine)
{
    const Blocks blocks = findBlocks(fine.cells.places);
    CoarseProblem coarse;
    coarse.side = kSide;
    FitProblem& p = coarse.problem;
    p.cells = buildFitCells(blocks.places);
    p.lobes = fine.lobes;
    p.size = fine.size;
    p.directions = fine.directions;
    p.minimumLogSharpness = fine.minimumLogSharpness;
    p.maximumLogSharpness = fine.maximumLogSharpness;
    averageImages(fine, blocks, p);
    return coarse;
}

SgField interpolateBlocks(const FitProblem& fine, const CoarseProblem& coarse,
                          const SgField& blocks)
{
    const FitProblem& from = coarse.problem;
    const FitPlaces known(from.cells.places);
    SgField field;
    field.lobeCount = fine.lobes;
    field.lobes.assign(std::size_t(fine.texelCount()) * fine.lobes, SgLobe{});
    for (std::uint32_t t = 0; t < fine.texelCount(); ++t) {
        const glm::uvec3 place = fine.cells.places[t];
        const glm::vec2 at = (glm::vec2(place) + 0.5f) / float(coarse.side) - 0.5f;
        const glm::vec2 low = glm::floor(at), part = at - low;
        float total = 0.0f;
        std::vector<SgLobe> sums(fine.lobes, SgLobe{.axis = glm::vec3(0.0f)});
        for (int corner = 0; corner < 4; ++corner) {
            const int dx = corner & 1, dy = corner >> 1;
            const std::uint32_t block = known.at(int(low.x) + dx, int(low.y) + dy, place.z);
            if (block == gpu::kSgFitNone)
                continue;
            const float weight =
                (dx == 1 ? part.x : 1.0f - part.x) * (dy == 1 ? part.y : 1.0f - part.y);
            total += weight;
            for (std::uint32_t k = 0; k < fine.lobes; ++k) {
                const SgLobe more = weighted(blocks.lobes[std::size_t(block) * fine.lobes + k],
                                             weight, 1.0f / std::abs(from.scales[block]));
                sums[k].axis += more.axis;
                sums[k].logSharpness += more.logSharpness;
                sums[k].amplitude += more.amplitude;
            }
        }
        for (std::uint32_t k = 0; k < fine.lobes; ++k)
            field.lobes[std::size_t(t) * fine.lobes + k] = {
                gpu::safeNormalize(sums[k].axis, glm::vec3(0.0f, 0.0f, 1.0f)),
                sums[k].logSharpness / total,
                sums[k].amplitude * (std::abs(fine.scales[t]) / total)};
    }
    return field;
}

void matchBrightness(const FitProblem& problem, const FitSettings& settings, SgField& field)
{
    const std::size_t texels = problem.texelCount();
    for (std::size_t t = 0; t < texels; ++t) {
        if (problem.scales[t] <= 0.0f)
            continue; // no image
        const std::span<SgLobe> lobes(&field.lobes[t * problem.lobes], problem.lobes);
        double seenByLobes = 0.0, ofLobes = 0.0;
        for (std::size_t d = 0; d < problem.directionCount(); ++d) {
            const glm::vec3 seen = gpu::unpackRgb9e5(problem.images[d * texels + t]);
            const float brightness = (seen.x + seen.y + seen.z) / 3.0f / problem.scales[t];
            const float weight =
                problem.directions[d].w / (1.0f + settings.peakSoftening * brightness);
            glm::vec3 light(0.0f);
            for (const SgLobe& lobe : lobes)
                light += lobe.amplitude * gpu::sgEvaluate(glm::vec3(problem.directions[d]),
                                                          lobe.axis, std::exp(lobe.logSharpness));
            seenByLobes += double(weight * glm::dot(seen, light));
            ofLobes += double(weight * glm::dot(light, light));
        }
        const float gain = ofLobes > 0.0 ? float(std::max(seenByLobes / ofLobes, 0.0)) : 1.0f;
        for (SgLobe& lobe : lobes)
            lobe.amplitude *= gain;
    }
}

} // namespace strandlight
