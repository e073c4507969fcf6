// All strands blended without noise, in slices of depth that the samples of stochastic transparency
// choose: two draws of the strands in place of sorting them.
#pragma once

#include "passes/hair_passes.hpp"

namespace strandlight {

// Two images, RGBA32F [height, width]: the depths in metres at which kHairSlices slices end, 1e30
// for those that hold nothing. `samples` come with features, else it throws Error.
struct HairCuts
{
    ImageId first, second;
};
HairCuts addHairCutsPass(RenderGraph& graph, const HairSampleIds& samples);

// RGBA32F [height, width]: premultiplied radiance of all strands that nothing opaque hides, and the
// transmittance, the product of 1 - alpha; 1 exactly where there is none. `shaded` is that of
// addHairShadingPasses. Sums are kept as halves: within 0.1 % of themselves.
ImageId addHairBlendPass(RenderGraph& graph, HairBuffers& buffers, BufferId shaded,
                         const HairView& view, const HairCuts& cuts);

} // namespace strandlight
