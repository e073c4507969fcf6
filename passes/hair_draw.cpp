#include "passes/hair_draw.hpp"

#include "kernels/hair.gen.hpp"

namespace strandlight {

gpu::HairStrandPush strandPush(const HairBuffers& buffers, const HairView& view)
{
    gpu::HairStrandPush push{};
    push.viewProjection = view.viewProjection;
    push.size = glm::vec2(view.width, view.height);
    push.jitter = view.jitter;
    // Clip y per metre: the length of the second row's linear part.
    const glm::mat4& m = view.viewProjection;
    push.pixelsPerUnit =
        0.5f * float(view.height) * glm::length(glm::vec3(m[0][1], m[1][1], m[2][1]));
    push.widthScale = buffers.widthScale;
    push.minimumWidth = view.trueWidth ? 0.0f : 1.0f;
    push.alpha = view.alpha;
    push.frame = view.frame;
    return push;
}

gpu::HairOpaquePush opaquePush(const HairView& view)
{
    gpu::HairOpaquePush push{};
    push.viewProjection = view.viewProjection;
    push.size = glm::vec2(view.width, view.height);
    push.jitter = view.jitter;
    return push;
}

void drawOpaque(RenderGraph& graph, PassBuilder& pass, HairBuffers& buffers,
                const gpu::HairOpaquePush& push, const KernelBlob& fragment, Blend blend)
{
    if (buffers.triangleCount == 0)
        return;
    const BufferId surface = pass.read(graph.importBuffer(buffers.surface));
    const BufferId lights = pass.read(graph.importBuffer(buffers.lights));
    const BufferId visibility = pass.read(graph.importBuffer(buffers.visibility));
    const BufferId lobes = pass.read(graph.importBuffer(buffers.lobes));
    const RasterDesc raster{
        .vertex = &kernels::hair_opaque_vert, .fragment = &fragment, .blend = blend};
    pass.draw(raster, buffers.triangleCount * 3, 1, push, {surface, lights, visibility, lobes});
}

StrandIds readStrands(RenderGraph& graph, PassBuilder& pass, HairBuffers& buffers)
{
    return {pass.read(graph.importBuffer(buffers.points)),
            pass.read(graph.importBuffer(buffers.tangents)),
            pass.read(graph.importBuffer(buffers.segments))};
}

ImageId addHairShadowPass(RenderGraph& graph, HairBuffers& buffers, const std::string& name,
                          const gpu::HairLight& light, const HairShadowMap& settings)
{
    // One pass clears, draws what hides and then what hides at random.
    PassBuilder pass = graph.addRasterPass(name);
    const std::uint32_t size = settings.size;
    const ImageId map =
        pass.depth(graph.createImage("hair shadow map", {size, size, 1, Format::Depth32F, 4}));
    HairView view;
    view.viewProjection = light.shadowMatrix;
    view.width = view.height = size;
    view.alpha = settings.alpha;
    view.frame = settings.frame + 0x40000000u + settings.masks; // masks unlike the camera's
    drawOpaque(graph, pass, buffers, opaquePush(view), kernels::hair_depth_frag, Blend::None);

    StrandIds strands = readStrands(graph, pass, buffers);
    gpu::HairStrandPush push = strandPush(buffers, view);
    std::uint32_t segments = buffers.segmentCount;
    if (settings.sparse) {
        strands.segments = pass.read(graph.importBuffer(buffers.sparse));
        segments = buffers.sparseSegments;
        push.widthScale = buffers.sparseScale;
    }
    const RasterDesc raster{.vertex = &kernels::hair_silhouette_vert,
                            .fragment = &kernels::hair_shadow_frag};
    pass.draw(raster, segments * 6, 1, push, {strands.points, strands.tangents, strands.segments});
    return map;
}

} // namespace strandlight
