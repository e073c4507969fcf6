// The baked light: spherical gaussians over the atlas, and everything a renderer needs to find
// them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/atlas.hpp"

namespace strandlight {

// One lobe in the texel's frame (T, B, N): radiance(d) = amplitude * exp(-sharpness/2 |d -
// axis|^2).
struct SgLobe
{
    glm::vec3 axis = glm::vec3(0.0f, 0.0f, 1.0f); // unit
    float logSharpness = 0.0f;                    // ln(lambda)
    glm::vec3 amplitude = glm::vec3(0.0f);        // W / (sr m^2)
};

inline constexpr std::uint32_t kMaximumLobes = 32; // bits of a mask

// Lobes of every covered texel. Bilinear interpolation acts on axis (then normalised), ln sharpness
// and amplitude. Lobe k is the same light in neighbouring texels, so a texel can do without it:
// then it is interpolated with amplitude 0 and takes axis and sharpness from the texels that keep
// it.
struct SgField
{
    std::uint32_t lobeCount = 0;
    std::vector<SgLobe> lobes; // [texel, lobe], texels in the order of Atlas::texels
    std::uint32_t tileSize =
        0; // of lobeTiles(): the texels of a tile keep the same; 0: all keep all
    std::vector<std::uint32_t> kept; // [texel] bit k: lobe k is kept; empty with tileSize 0

    std::uint32_t allLobes() const { return ~0u >> (kMaximumLobes - lobeCount); }
    std::uint32_t keptBy(std::size_t texel) const
    {
        return kept.empty() ? allLobes() : kept[texel];
    }
    std::uint64_t keptCount() const; // over all texels
};

// The lobe between texels, as shading has it (shaders/sg/lobe_fetch.glsl). `weights` add up to 1.
SgLobe interpolateLobe(const SgField& field, const glm::uvec4& texels, const glm::vec4& weights,
                       std::uint32_t lobe);

// The texels of one chart within one square of tileSize x tileSize atlas texels are a tile. Tiles
// are counted in the order in which Atlas::texels meets them.
struct LobeTiles
{
    std::uint32_t count = 0;
    std::vector<std::uint32_t> tileOf; // [texel]
};
LobeTiles lobeTiles(const Atlas& atlas, std::uint32_t tileSize);

// What a bake was made with; stored in the file, shown by `strandlight info`.
struct BakeInfo
{
    std::string scene;
    std::string fitMode; // "direct", "cnn", "cnn+refine"
    std::uint64_t geometryHash =
        0; // of triangle positions; rendering another scene with this bake is refused
    std::uint64_t environmentHash = 0;
    std::uint32_t lightfieldSize = 0; // directions per side
    std::uint32_t samplesPerDirection = 0;
    std::uint32_t bounces = 0;
    std::uint32_t steps = 0;
    std::uint32_t seed = 0;
    float rmse = 0.0f; // light field against its lobes, at texels
};

struct SgBake
{
    BakeInfo info;
    Atlas atlas;
    SgField radiance; // everything but the distant environment seen directly
    std::optional<SgField>
        environment; // environment radiance times visibility; absent without an environment
};

} // namespace strandlight
