// Procedural hair: deterministic grooms on the head of hair_head.hpp, for first runs, tests and
// training.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/scene/hair.hpp"

namespace strandlight {

inline constexpr std::uint32_t kMostGroomStrands = 200000;
inline constexpr std::uint32_t kMostGroomSegments = 256;

struct GroomSettings
{
    std::uint32_t strands = 40000;       // 1 .. kMostGroomStrands
    std::uint32_t segments = 16;         // per strand, 1 .. kMostGroomSegments
    float lengthMetres = 0.3f;           // of the longest strand, 0.005 .. 2
    float lengthVariation = 0.2f;        // the shortest is this part shorter, 0 .. 0.9
    float radiusMetres = 5e-5f;          // at the root, 1e-6 .. 1e-2
    float clumping = 0.5f;               // 0: every strand for itself, 1: tips of a lock meet
    float frizz = 0.1f;                  // 0 .. 1, deviation of the direction
    glm::vec3 color{0.3f, 0.17f, 0.09f}; // linear albedo
    float colorVariation = 0.3f;         // 0 .. 1
    std::uint32_t seed = 1;
};

// "straight", "wavy", "curly", "afro", "ponytail", "short".
const std::vector<std::string>& groomNames();

// What suits the style. Throws Error when there is no such style.
GroomSettings groomSettings(const std::string& name);

// Roots lie on the scalp, strands do not enter the head, the length of strand s does not depend on
// the number of segments. The same arguments give the same bits. Throws Error when there is no such
// style or a setting is out of its range.
HairStrands makeGroom(const std::string& name, const GroomSettings& settings);

} // namespace strandlight
