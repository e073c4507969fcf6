// What the frames of the filter network's training pool show: grooms, lights and views, all drawn
// from (seed, frame).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/grooms.hpp"
#include "engine/scene/scene.hpp"

namespace strandlight {

struct HairTrainingLook
{
    std::string style;
    GroomSettings groom;
    bool head = true; // else the strands alone, seen through
    std::vector<PunctualLight> lights;
    glm::vec3 ambient{0.0f};
    float roughness = 0.3f;

    glm::vec3 viewDirection{0.0f, 0.0f, 1.0f}; // from what is looked at to the eye, unit
    float viewHeight = 0.5f;                   // metres that the picture's height shows
    glm::vec2 aim{0.0f};                       // which strand, and where along it, in [0, 1)
    float aimShare = 1.0f; // 1: that place is the picture's middle, 0: the groom's middle
};

// Frame `index` of a pool. Training frames never show the style `kHeldOutStyle`; held-out frames
// begin with it and draw their grooms from other random numbers. A pure function.
HairTrainingLook hairTrainingLook(std::uint32_t seed, std::uint32_t index, bool heldOut);

inline constexpr const char* kHeldOutStyle = "ponytail";

Camera hairTrainingCamera(const HairTrainingLook& look, const HairStrands& hair);

} // namespace strandlight
