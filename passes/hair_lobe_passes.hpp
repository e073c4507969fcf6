// Distant light on strands: a few spherical gaussians through the hair BSDF.
// The sharp ones with most of the light have a stochastic shadow map along their axis. The wide
// ones arrive from so many directions that one map would be wrong about most of them: they see the
// mean and first moment of the visibility in eight directions, from small maps of fewer strands.
#pragma once

#include "passes/hair_passes.hpp"

namespace strandlight {

// Fills `lobes`, `openness`, `along` and `sparse` of the buffers.
void uploadHairLobes(Context& context, HairBuffers& buffers, const HairStrands& hair,
                     const Scene* opaque, const HairDistantLight& distant,
                     const HairRenderSettings& settings);

// Adds the lobes' radiance to `shaded`, or starts it when `first`. Without shadows all is visible.
BufferId addHairLobePasses(RenderGraph& graph, HairBuffers& buffers, BufferId shaded, bool first,
                           const HairDistantLight& distant, const HairView& view,
                           const HairRenderSettings& settings);

} // namespace strandlight
