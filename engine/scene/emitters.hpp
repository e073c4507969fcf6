// What light sampling chooses from: emissive triangles and punctual lights by power, environment
// cells by radiance.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/bvh.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/texture_pool.hpp"

namespace strandlight {

// Draws index i with probability weights[i] / sum in constant time.
// Vose. A Linear Algorithm for Generating Random Numbers with a Given Distribution. 1991
struct AliasTable
{
    std::vector<float> thresholds;     // keep the column if rest < threshold
    std::vector<std::uint32_t> others; // else take this one
    std::vector<float> probabilities;
};
// Weights must be finite and not negative, with a positive sum; throws Error otherwise.
AliasTable buildAliasTable(const std::vector<double>& weights);

// An entry is (threshold as float bits, other entry, target, probability as float bits). The target
// is a triangle in leaf order, or kPunctualBit | index into Scene::lights.
struct EmitterTable
{
    std::vector<glm::uvec4> entries;    // empty: nothing emits
    std::vector<float> triangleDensity; // [leaf order] 1/m^2 of sampled points; 0: not sampled
};
EmitterTable buildEmitterTable(const Scene& scene, const Bvh& bvh, const TexturePool& textures);

// Importance grid of the environment: cells of (threshold, other cell, density per unit uv area,
// unused).
struct EnvironmentGrid
{
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<glm::vec4> cells;
};
// At most 512 x 256 cells: finer ones would cost more memory than they save noise.
EnvironmentGrid buildEnvironmentGrid(const Environment& environment);

} // namespace strandlight
