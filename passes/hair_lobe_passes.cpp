#include "passes/hair_lobe_passes.hpp"

#include <cmath>
#include <string>

#include "kernels/hair.gen.hpp"
#include "passes/hair_draw.hpp"

namespace strandlight {
namespace {

static_assert(sizeof(gpu::HairLobe) == 32 && sizeof(gpu::HairLobePush) == 40 &&
              sizeof(gpu::HairOpenPush) == 16);

// A wide lobe's shadow has no detail: about 2 mm of a head a texel.
constexpr std::uint32_t kOpenSize = 256;
constexpr std::uint32_t kOpenMasks = 0x1000u;

glm::vec3 openDirection(std::uint32_t corner)
{
    const glm::vec3 signs(corner & 1u ? 1 : -1, corner & 2u ? 1 : -1, corner & 4u ? 1 : -1);
    return signs / std::sqrt(3.0f);
}

BufferId addOpennessPasses(RenderGraph& graph, HairBuffers& buffers, std::uint32_t mapped,
                           const HairRenderSettings& settings)
{
    BufferId openness = graph.importBuffer(buffers.openness);
    for (std::uint32_t i = 0; i < gpu::kHairOpenDirections; ++i) {
        const ImageId map = addHairShadowPass(graph, buffers, "hair openness shadow",
                                              buffers.alongLights[mapped + i],
                                              {.size = kOpenSize,
                                               .masks = kOpenMasks + i,
                                               .alpha = settings.alpha,
                                               .frame = settings.frameIndex,
                                               .sparse = true});
        PassBuilder pass = graph.addComputePass("hair openness");
        const BufferId points = pass.read(graph.importBuffer(buffers.points));
        const BufferId table = pass.read(graph.importBuffer(buffers.along));
        openness = pass.write(openness);
        pass.sample(map);
        const gpu::HairOpenPush push{buffers.pointCount, mapped + i, i == 0 ? 1u : 0u, kOpenSize};
        pass.dispatch(kernels::hair_openness, {buffers.pointCount, 1, 1}, push,
                      {points, openness, table, Binding(map, Filter::Nearest)});
    }
    return openness;
}

// What all strand points are lit by in one pass.
struct PointIds
{
    BufferId points, tangents, colors, lobes;
};

PointIds readPoints(RenderGraph& graph, PassBuilder& pass, HairBuffers& buffers)
{
    return {pass.read(graph.importBuffer(buffers.points)),
            pass.read(graph.importBuffer(buffers.tangents)),
            pass.read(graph.importBuffer(buffers.colors)),
            pass.read(graph.importBuffer(buffers.lobes))};
}

BufferId addMappedLobePass(RenderGraph& graph, HairBuffers& buffers, BufferId shaded,
                           const gpu::HairLobePush& push, const HairRenderSettings& settings)
{
    const std::string number = std::to_string(push.lobe);
    const ImageId map = addHairShadowPass(graph, buffers, "hair lobe shadow " + number,
                                          buffers.alongLights[push.lobe],
                                          {.size = settings.shadowSize,
                                           .masks = kOpenMasks / 2 + push.lobe,
                                           .alpha = settings.alpha,
                                           .frame = settings.frameIndex});
    PassBuilder pass = graph.addComputePass("hair lobe " + number);
    const PointIds ids = readPoints(graph, pass, buffers);
    const BufferId along = pass.read(graph.importBuffer(buffers.along));
    shaded = pass.write(shaded);
    pass.sample(map);
    pass.dispatch(kernels::hair_lobe_shadowed, {buffers.pointCount, 1, 1}, push,
                  {ids.points, ids.tangents, ids.colors, shaded, ids.lobes, along,
                   Binding(map, Filter::Nearest)});
    return shaded;
}

} // namespace

void uploadHairLobes(Context& context, HairBuffers& buffers, const HairStrands& hair,
                     const Scene* opaque, const HairDistantLight& distant,
                     const HairRenderSettings& settings)
{
    buffers.lobes = Buffer::from(context, distant.lobes, "hair lobes");
    // Maps that begin at the hair's bounds clip what lies before them.
    const Scene* reach = distant.local ? nullptr : opaque;
    for (std::uint32_t i = 0; i < distant.mapped; ++i)
        buffers.alongLights.push_back(
            hairShadowDirection(hair, reach, distant.lobes[i].axis, settings.shadowSize));
    for (std::uint32_t i = 0; i < gpu::kHairOpenDirections; ++i)
        buffers.alongLights.push_back(
            hairShadowDirection(hair, reach, openDirection(i), kOpenSize));
    buffers.along = Buffer::from(context, buffers.alongLights, "hair lobe shadows");
    // All visible until the passes say otherwise.
    const std::vector<glm::vec4> open(buffers.pointCount, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    buffers.openness = Buffer::from(context, open, "hair openness");
}

BufferId addHairLobePasses(RenderGraph& graph, HairBuffers& buffers, BufferId shaded, bool first,
                           const HairDistantLight& distant, const HairView& view,
                           const HairRenderSettings& settings)
{
    gpu::HairLobePush push{};
    push.eye = view.eye;
    push.roughness = settings.roughness;
    push.tilt = glm::radians(settings.tiltDegrees);
    push.pointCount = buffers.pointCount;
    push.first = first ? 1 : 0;
    push.shadowSize = settings.shadowSize;
    const std::uint32_t mapped = settings.shadows ? distant.mapped : 0;
    push.lobeCount = 1;
    for (push.lobe = 0; push.lobe < mapped; ++push.lobe) {
        shaded = addMappedLobePass(graph, buffers, shaded, push, settings);
        push.first = 0;
    }
    push.lobeCount = std::uint32_t(distant.lobes.size()) - mapped;
    if (push.lobeCount == 0)
        return shaded;
    const BufferId openness = settings.shadows
                                  ? addOpennessPasses(graph, buffers, distant.mapped, settings)
                                  : graph.importBuffer(buffers.openness);
    PassBuilder pass = graph.addComputePass("hair lobes");
    const PointIds ids = readPoints(graph, pass, buffers);
    pass.read(openness);
    shaded = pass.write(shaded);
    pass.dispatch(kernels::hair_lobes, {buffers.pointCount, 1, 1}, push,
                  {ids.points, ids.tangents, ids.colors, shaded, ids.lobes, openness});
    return shaded;
}

} // namespace strandlight
