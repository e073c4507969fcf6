// What a hair frame took, and what it did without: milliseconds by pass, blocks that no strand
// touches, tiles that the network left out.
#pragma once

#include <span>
#include <vector>

#include "compute_nn/unet_tiles.hpp"
#include "passes/hair_render.hpp"

namespace strandlight {

// Milliseconds of the same pass are added up.
void addHairTimings(std::vector<PassTiming>& sum, std::span<const PassTiming> more);

// Fills blocks and emptyBlocks from exactTransmittance.
void countHairBlocks(HairFrame& frame);

// After the graph has run, with the layers' arguments as outputs. Bands of a layer count together.
std::vector<HairTileCount> countHairTiles(const RenderGraph& graph,
                                          std::span<const LayerTiles> layers);

} // namespace strandlight
