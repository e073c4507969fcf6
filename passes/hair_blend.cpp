#include "passes/hair_blend.hpp"

#include <array>
#include <string>

#include "engine/base/error.hpp"
#include "kernels/hair.gen.hpp"
#include "passes/hair_draw.hpp"

namespace strandlight {
namespace {

// One more for the quarters of the pixels.
using Slices = std::array<ImageId, gpu::kHairSlices + 1>;

// RGBA16F: half the memory, and no difference in error that could be measured.
Slices addSlicesPass(RenderGraph& graph, HairBuffers& buffers, BufferId shaded,
                     const HairView& view, const HairCuts& cuts)
{
    const ImageDesc desc{view.width, view.height, 1, Format::RGBA16F, 1};
    Slices slices;
    PassBuilder pass = graph.addRasterPass("hair blend");
    for (std::size_t i = 0; i < slices.size(); ++i)
        slices[i] = pass.color(graph.createImage("hair slice " + std::to_string(i), desc),
                               {true, glm::vec4(0.0f)});
    [[maybe_unused]] const ImageId depth =
        pass.depth(graph.createImage("hair blend depth", desc.with(Format::Depth32F)));
    drawOpaque(graph, pass, buffers, opaquePush(view), kernels::hair_blend_opaque_frag, Blend::Add);
    const StrandIds strands = readStrands(graph, pass, buffers);
    pass.read(shaded);
    pass.sample(cuts.first);
    pass.sample(cuts.second);
    const RasterDesc raster{.vertex = &kernels::hair_blend_vert,
                            .fragment = &kernels::hair_blend_frag,
                            .depthWrite = false,
                            .blend = Blend::Add};
    pass.draw(raster, buffers.segmentCount * 6, 1, strandPush(buffers, view),
              {strands.points, strands.tangents, strands.segments, shaded,
               Binding(cuts.first, Filter::Nearest), Binding(cuts.second, Filter::Nearest)});
    return slices;
}

} // namespace

HairCuts addHairCutsPass(RenderGraph& graph, const HairSampleIds& samples)
{
    if (!samples.features.valid())
        throw Error("hair: slices of depth need strands drawn with features");
    const glm::uvec3 extent = graph.extent(samples.features);
    const ImageDesc desc{extent.x, extent.y, 1, Format::RGBA32F, 1};
    PassBuilder pass = graph.addComputePass("hair cuts");
    pass.sample(samples.features);
    HairCuts cuts;
    cuts.first = pass.write(graph.createImage("hair cuts 0 to 3", desc));
    cuts.second = pass.write(graph.createImage("hair cuts 4 and 5", desc));
    pass.dispatch(kernels::hair_cuts, extent, gpu::HairResolvePush{extent.x, extent.y, 1.0f, 4},
                  {Binding(samples.features, Filter::Nearest), cuts.first, cuts.second});
    return cuts;
}

ImageId addHairBlendPass(RenderGraph& graph, HairBuffers& buffers, BufferId shaded,
                         const HairView& view, const HairCuts& cuts)
{
    const Slices slices = addSlicesPass(graph, buffers, shaded, view, cuts);
    PassBuilder pass = graph.addComputePass("hair blend resolve");
    const auto slice = [&](std::size_t i) {
        return Binding(pass.sample(slices[i]), Filter::Nearest);
    };
    const ImageId blended = pass.write(
        graph.createImage("hair blended", {view.width, view.height, 1, Format::RGBA32F, 1}));
    pass.dispatch(
        kernels::hair_blend_resolve, {view.width, view.height, 1},
        gpu::HairResolvePush{view.width, view.height, 1.0f, 1},
        {slice(0), slice(1), slice(2), slice(3), slice(4), slice(5), slice(6), slice(7), blended});
    return blended;
}

} // namespace strandlight
