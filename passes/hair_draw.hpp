// How the hair passes draw strands and opaque triangles, into pictures and into shadow maps.
#pragma once

#include <cstdint>
#include <string>

#include "passes/hair_passes.hpp"

namespace strandlight {

gpu::HairStrandPush strandPush(const HairBuffers& buffers, const HairView& view);
gpu::HairOpaquePush opaquePush(const HairView& view);

void drawOpaque(RenderGraph& graph, PassBuilder& pass, HairBuffers& buffers,
                const gpu::HairOpaquePush& push, const KernelBlob& fragment, Blend blend);

// What every strand draw reads.
struct StrandIds
{
    BufferId points, tangents, segments;
};
StrandIds readStrands(RenderGraph& graph, PassBuilder& pass, HairBuffers& buffers);

struct HairShadowMap
{
    std::uint32_t size = 1024; // texels a side
    std::uint32_t masks = 0;   // another number is another noise
    float alpha = 1.0f;
    std::uint32_t frame = 0;
    bool sparse = false; // of HairBuffers::sparse alone
};

// D32F, four samples a texel: the nearest of what hides, through random masks of strands.
ImageId addHairShadowPass(RenderGraph& graph, HairBuffers& buffers, const std::string& name,
                          const gpu::HairLight& light, const HairShadowMap& settings);

} // namespace strandlight
