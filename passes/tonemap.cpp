#include "passes/tonemap.hpp"

#include <cmath>

#include "kernels/post.gen.hpp"
#include "shaders/shared/shade_types.h"

namespace strandlight {

ImageId addTonemapPass(RenderGraph& graph, ImageId hdr, const TonemapSettings& settings)
{
    PassBuilder pass = graph.addComputePass("tonemap");
    pass.read(hdr);
    const ImageId out =
        pass.write(graph.createImage("display", graph.desc(hdr).with(Format::RGBA8)));
    const glm::uvec3 extent = graph.extent(out);
    pass.dispatch(kernels::tonemap, extent,
                  gpu::TonemapPush{std::exp2(settings.exposure), extent.x, extent.y}, {hdr, out});
    return out;
}

} // namespace strandlight
