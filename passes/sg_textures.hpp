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

struct SgTextures
{
    std::uint32_t resolution = 0;       // of the atlas
    std::uint32_t radianceLobes = 0;    // per texel
    std::uint32_t environmentLobes = 0; // per texel, 0: none
    Buffer texelIndex;                  // uint [resolution, resolution]: covered texel or kNoTexel
    Buffer radiance;    // uvec4 [texels, radianceLobes], layout of shaders/sg/lobe_fetch.glsl
    Buffer environment; // uvec4 [texels, environmentLobes]
    Buffer corners;     // vec4 [triangles, 4]: (tangent, u) of three corners, then (v, v, v, 0)
};

// One lobe in 16 bytes. Halves: amplitudes beyond 65504 are clamped, ln(lambda) keeps lambda to 0.4
// %.
glm::uvec4 packSgLobe(const SgLobe& lobe);

// Throws Error when the lobe counts do not fit the atlas, or a buffer is larger than one binding
// may be.
SgTextures uploadSgTextures(Context& context, const SgBake& bake);

// One lobe set in a graph.
struct SgLobeIds
{
    BufferId texelIndex;
    BufferId lobes;
    std::uint32_t resolution = 0;
    std::uint32_t lobeCount = 0;
};
SgLobeIds importRadianceLobes(RenderGraph& graph, SgTextures& textures);
SgLobeIds importEnvironmentLobes(RenderGraph& graph, SgTextures& textures);

} // namespace strandlight
