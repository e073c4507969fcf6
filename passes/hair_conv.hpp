// The filter network's input, fetched from the samples by the layers that read it: the 26 planes
// never exist in memory.
#pragma once

#include <cstdint>

#include "compute_nn/unet.hpp"
#include "passes/hair_filter.hpp"

namespace strandlight {

// Whether that is faster than the planes of addHairInputPass, by class of device: as measured.
bool hairFetchPays(const Context& context);

// For unetForward, in place of the planes that addHairInputPass would write into a tensor of the
// shape x from `firstRow` on. Throws Error when the samples came without features.
UNetFetch hairFetch(RenderGraph& graph, const HairFilterInput& input, const TensorDesc& x,
                    std::uint32_t firstRow);

} // namespace strandlight
