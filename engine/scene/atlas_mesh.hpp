// The scene's triangles as the atlas builder sees them: welded by position, with neighbours and
// face normals.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/scene.hpp"

namespace strandlight {

// An edge that two triangles share. `edge` is the corner at which it starts in the first,
// `otherEdge` in the second.
struct AtlasNeighbour
{
    std::uint32_t triangle = 0;
    std::uint8_t edge = 0;
    std::uint8_t otherEdge = 0;
    bool sameDirection = false; // both triangles run along it the same way: their windings disagree
};

class AtlasMesh
{
public:
    // Throws Error for vertices that are not finite and for scenes without any triangle of positive
    // area.
    explicit AtlasMesh(const Scene& scene);

    std::uint32_t triangleCount() const { return static_cast<std::uint32_t>(areas_.size()); }
    glm::vec3 position(std::uint32_t triangle, std::uint32_t corner) const;
    glm::vec3 shadingNormal(std::uint32_t triangle, std::uint32_t corner) const;
    glm::vec3 normal(std::uint32_t triangle) const { return normals_[triangle]; } // unit; 0 if thin
    float area(std::uint32_t triangle) const { return areas_[triangle]; }

    // Thin triangles (height under a millionth of the longest edge) have no usable normal; they
    // follow a neighbour.
    bool isThin(std::uint32_t triangle) const { return thin_[triangle]; }
    std::span<const AtlasNeighbour> neighbours(std::uint32_t triangle) const;
    const Scene& scene() const { return scene_; }

private:
    void computeFaces();
    void computeNeighbours();

    const Scene& scene_;
    std::vector<glm::vec3> normals_;            // [triangle]
    std::vector<float> areas_;                  // [triangle]
    std::vector<bool> thin_;                    // [triangle]
    std::vector<std::uint32_t> firstNeighbour_; // [triangle + 1]
    std::vector<AtlasNeighbour> neighbours_;
};

// Vertices of equal position get equal numbers. [vertices]
std::vector<std::uint32_t> weldPositions(std::span<const Vertex> vertices);

} // namespace strandlight
