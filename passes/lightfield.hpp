// The captured light: a hemi-octahedral image of incoming radiance per covered atlas texel, in the
// texel's frame (T, B, N).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "engine/vk/buffer.hpp"

namespace strandlight {

// A range of texels whose images fit one storage binding; words are RGB9E5 (shared/rgb9e5.h).
// Cell (x, y) is word y * size + x. It covers hemiOctDecode of ((x, y) + [0,1)^2) / size
// (shared/octahedral.h) and holds the mean radiance over the cell, W / (sr m^2).
struct LightfieldPart
{
    std::uint32_t firstTexel = 0;
    std::uint32_t texelCount = 0;
    // uint [texelCount, size * size]: all but the distant environment seen directly.
    Buffer radiance;
    // The same shape: environment radiance times visibility. Not valid() without an environment.
    Buffer environment;
};

struct Lightfield
{
    std::uint32_t size = 0;       // cells per side
    std::uint32_t texelCount = 0; // = Atlas::texels.size(), same order
    bool hasEnvironment = false;
    // Consecutive ranges; more than one only where a buffer would pass the binding limit.
    std::vector<LightfieldPart> parts;
    // [texelCount]; 0: the texel lies inside geometry and its image means nothing.
    std::vector<std::uint8_t> valid;
    std::uint64_t clampedCells = 0; // cells outside the range of the packing (brighter than 65408)

    std::uint32_t directionCount() const { return size * size; }
};

// The same images on the CPU.
struct CpuLightfield
{
    std::uint32_t size = 0;
    std::uint32_t texelCount = 0;
    std::vector<std::uint32_t> radiance;    // [texelCount, size * size] RGB9E5
    std::vector<std::uint32_t> environment; // the same, or empty
    std::vector<std::uint8_t> valid;        // [texelCount]

    glm::vec3 radianceAt(std::uint32_t texel, std::uint32_t direction) const;
    glm::vec3 environmentAt(std::uint32_t texel,
                            std::uint32_t direction) const; // 0 without an environment
};

// Waits for the device.
CpuLightfield downloadLightfield(const Lightfield& field);

// Splits texels so that no buffer is larger than the binding limit, and uploads. For tests and
// restored bakes.
Lightfield uploadLightfield(Context& context, const CpuLightfield& field);

// float [count, 3] from RGB9E5 words.
std::vector<glm::vec3> unpackRadiance(const std::vector<std::uint32_t>& words);

} // namespace strandlight
