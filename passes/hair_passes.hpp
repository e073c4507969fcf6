// The hair passes of one frame, each on its own: a network that filters the samples goes behind
// addHairStrandsPass.
#pragma once

#include <cstdint>
#include <span>

#include "compute_nn/tile_list.hpp"
#include "engine/graph/render_graph.hpp"
#include "passes/hair_strands.hpp"

namespace strandlight {

struct HairView
{
    glm::mat4 viewProjection = glm::mat4(1.0f);
    glm::vec3 eye = glm::vec3(0.0f);
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    glm::vec2 jitter = glm::vec2(0.0f); // pixels
    std::uint32_t frame = 0;
    bool trueWidth = false; // else ribbons are at least a pixel wide
    float alpha = 1.0f;
};

// Four samples a pixel, RGBA16F; what they hold is in shaders/hair/hair_features.frag.
struct HairSampleIds
{
    ImageId color;    // radiance, 1 where hair
    ImageId features; // brightness, illumination, transparency, depth; 0, 0, 1, 0 without hair
    ImageId shape;    // tangent in the picture, 0, 0
    ImageId depth;    // D32F
};

struct HairSums
{
    ImageId hair;   // RGBA32F [height, width], premultiplied radiance, transmittance
    ImageId behind; // RGBA32F, radiance beside the hair times its share, that share
};

// Radiance of the strand points into `shaded` of the buffers, one pass (and one shadow map) a
// light. `shadowed` says which lights have maps.
BufferId addHairShadingPasses(RenderGraph& graph, HairBuffers& buffers,
                              std::span<const gpu::HairLight> lights,
                              const std::vector<bool>& shadowed, const HairView& view,
                              const HairRenderSettings& settings);

// Opaque triangles, shaded into `color` or, without `plainSurfaces`, depth alone.
HairSampleIds addHairOccludersPass(RenderGraph& graph, HairBuffers& buffers, const HairView& view,
                                   const HairRenderSettings& settings, std::uint32_t lightCount,
                                   bool plainSurfaces);

// The picture without hair into `radiance`, RGBA32F: shaded triangles before the constant colour.
ImageId addHairBackdropPass(RenderGraph& graph, HairBuffers& buffers, const HairView& view,
                            const HairRenderSettings& settings, std::uint32_t lightCount,
                            ImageId radiance);

// Opaque triangles, then strands. With `plainSurfaces` the triangles are shaded, else they only
// hide. Features and shape stay invalid ids unless `wantFeatures`.
HairSampleIds addHairStrandsPass(RenderGraph& graph, HairBuffers& buffers, BufferId shaded,
                                 const HairView& view, const HairRenderSettings& settings,
                                 std::uint32_t lightCount, bool plainSurfaces, bool wantFeatures);

// R32F [height, width]: the product of 1 - alpha over all strands that nothing opaque hides.
ImageId addHairCoveragePass(RenderGraph& graph, HairBuffers& buffers, const HairView& view);

// Adds weight times the mean of the first `count` of the four samples to the sums.
HairSums addHairResolvePass(RenderGraph& graph, const HairSampleIds& samples, HairSums sums,
                            float weight, std::uint32_t count = 4);

// Adds weight times the mean illumination of the four samples to `sum`, R32F [height, width]; 0
// counts where there is no hair. Throws Error when the samples came without features.
ImageId addHairIlluminationPass(RenderGraph& graph, const HairSampleIds& samples, ImageId sum,
                                float weight);

// [1,26,H,W] of the network's input: the picture's sides, rounded up to multiples of 8.
TensorDesc hairInputDesc(std::uint32_t width, std::uint32_t height);

// Writes what a network reads into x, planes as kHairInputPlanes says; x is of hairInputDesc, or
// holds the rows of it from `firstRow` on, and may be a channel range (createUNetInput). With tiles
// only in those. `blended` is that of addHairBlendPass. Throws Error when x is none of these, or
// when the samples came without features.
TensorId addHairInputPass(RenderGraph& graph, const HairSampleIds& samples, ImageId blended,
                          const HairDepthScale& depth, const TensorId& x,
                          std::uint32_t firstRow = 0, const TileList* tiles = nullptr);

} // namespace strandlight
