// A bake as the shading passes read it: texel buffers of packed lobes, and the atlas of every
// triangle corner.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/render_graph.hpp"
#include "engine/vk/buffer.hpp"
#include "passes/sg_field.hpp"

namespace strandlight {

// One lobe set.
struct SgLobeBuffers
{
    Buffer texels; // uvec2 [resolution, resolution]: first lobe and mask of the kept ones;
                   // (kNoTexel, 0) where the atlas has no surface
    Buffer lobes;  // uvec4 [kept lobes], layout of shaders/sg/lobe_fetch.glsl; not valid() where no
                   // texel keeps one: there is nothing to be shaded with

    std::uint64_t bytes() const
    {
        return (texels.valid() ? texels.bytes() : 0) + (lobes.valid() ? lobes.bytes() : 0);
    }
};

struct SgTextures
{
    std::uint32_t resolution = 0; // of the atlas
    SgLobeBuffers radiance;
    SgLobeBuffers environment; // without an environment, or when none of it is seen: no buffers
    Buffer corners; // vec4 [triangles, 4]: (tangent, u) of three corners, then (v, v, v, 0)
};

inline constexpr std::uint64_t kDeviceLobeBytes = 16;

// One lobe in kDeviceLobeBytes. Halves: amplitudes beyond 65504 are clamped, ln(lambda) keeps
// lambda to 0.4
// %.
glm::uvec4 packSgLobe(const SgLobe& lobe);

// Throws Error when the lobe counts do not fit the atlas, or a buffer is larger than one binding
// may be.
SgTextures uploadSgTextures(Context& context, const SgBake& bake);

// One lobe set in a graph.
struct SgLobeIds
{
    BufferId texels;
    BufferId lobes;
    std::uint32_t resolution = 0;
};
SgLobeIds importLobes(RenderGraph& graph, SgLobeBuffers& lobes, std::uint32_t resolution);

} // namespace strandlight
