// Bounding volume hierarchy over a scene's triangles, in the layout of
// shaders/shared/trace_types.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/scene.hpp"
#include "shaders/shared/trace_types.h"

namespace strandlight {

struct Bvh
{
    gpu::BvhGrid grid{};
    std::vector<glm::uvec4> nodes;     // [8 octants, grid.nodeCount]
    std::vector<glm::uvec4> triangles; // [triangle, 3], leaf order; never empty (one unused entry)
    std::vector<std::uint32_t> order;  // leaf order to the scene's triangle index
    std::uint32_t depth = 0;           // of the deepest leaf; the root has depth 0

    gpu::BvhView view() const { return {nodes.data(), triangles.data()}; }
};

// Binned surface-area heuristic; the same scene gives the same bytes. Throws Error naming the
// triangle when a position is not finite.
Bvh buildBvh(const Scene& scene);

// The world-space corners of a triangle in leaf order.
struct TriangleCorners
{
    glm::vec3 a, b, c;
};
TriangleCorners triangleCorners(const Bvh& bvh, std::uint32_t slot);

} // namespace strandlight
