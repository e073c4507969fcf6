// From linear radiance to display values.
#pragma once

#include "engine/graph/render_graph.hpp"

namespace strandlight {

struct TonemapSettings
{
    float exposure = 0.0f; // stops: radiance is multiplied by 2^exposure
};

// Exposure, clamp, sRGB curve; RGBA8. NaN pixels come out magenta.
ImageId addTonemapPass(RenderGraph& graph, ImageId hdr, const TonemapSettings& settings = {});

} // namespace strandlight
