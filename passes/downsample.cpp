#include "passes/downsample.hpp"

#include <string>

#include "engine/base/error.hpp"
#include "kernels/post.gen.hpp"
#include "shaders/shared/shade_types.h"

namespace strandlight {

ImageId addDownsamplePass(RenderGraph& graph, ImageId source, std::uint32_t factor)
{
    ImageDesc desc = graph.desc(source);
    if (factor == 0 || desc.width % factor != 0 || desc.height % factor != 0)
        throw Error("downsample: " + std::to_string(desc.width) + "x" +
                    std::to_string(desc.height) + " is no multiple of " + std::to_string(factor));
    desc.width /= factor;
    desc.height /= factor;
    PassBuilder pass = graph.addComputePass("downsample");
    pass.read(source);
    const ImageId out = pass.write(graph.createImage("picture", desc));
    pass.dispatch(kernels::downsample, graph.extent(out),
                  gpu::DownsamplePush{desc.width, desc.height, factor}, {source, out});
    return out;
}

} // namespace strandlight
