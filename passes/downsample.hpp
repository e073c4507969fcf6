// Box filter from the render size to the picture's.
#pragma once

#include "engine/graph/render_graph.hpp"

namespace strandlight {

// Mean of factor x factor pixels of linear radiance. Throws Error when the size is not a multiple
// of the factor.
ImageId addDownsamplePass(RenderGraph& graph, ImageId source, std::uint32_t factor);

} // namespace strandlight
