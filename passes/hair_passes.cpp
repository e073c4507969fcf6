#include "passes/hair_passes.hpp"

#include <string>

#include "engine/base/error.hpp"
#include "kernels/hair.gen.hpp"
#include "passes/hair_draw.hpp"

namespace strandlight {
namespace {

static_assert(sizeof(gpu::HairStrandPush) == 100 && sizeof(gpu::HairOpaquePush) == 100 &&
              sizeof(gpu::HairShadePush) == 56 && sizeof(gpu::HairLight) == 120 &&
              sizeof(gpu::HairInputPush) == 36);

// Lets hair darken what is below it.
void addSurfaceShadowPass(RenderGraph& graph, HairBuffers& buffers, ImageId map,
                          std::uint32_t light, std::uint32_t shadowSize)
{
    PassBuilder pass = graph.addComputePass("hair surface shadow " + std::to_string(light));
    const BufferId surface = pass.read(graph.importBuffer(buffers.surface));
    const BufferId table = pass.read(graph.importBuffer(buffers.lights));
    const BufferId visibility = pass.write(graph.importBuffer(buffers.visibility));
    pass.sample(map);
    const std::uint32_t corners = buffers.triangleCount * 3;
    pass.dispatch(kernels::hair_surface_shadow, {corners, 1, 1},
                  gpu::HairSurfacePush{corners, light, shadowSize},
                  {surface, visibility, table, Binding(map, Filter::Nearest)});
}

} // namespace

BufferId addHairShadingPasses(RenderGraph& graph, HairBuffers& buffers,
                              std::span<const gpu::HairLight> lights,
                              const std::vector<bool>& shadowed, const HairView& view,
                              const HairRenderSettings& settings)
{
    BufferId shaded = graph.importBuffer(buffers.shaded);
    gpu::HairShadePush push{};
    push.eye = view.eye;
    push.roughness = settings.roughness;
    push.ambient = settings.distant ? glm::vec3(0.0f) : settings.ambient; // else a lobe
    push.tilt = glm::radians(settings.tiltDegrees);
    push.pointCount = buffers.pointCount;
    push.lightCount = std::uint32_t(lights.size());
    push.shadowSize = settings.shadowSize;
    push.share = hairLightShare(lights, settings);
    for (std::uint32_t i = 0; i < push.lightCount; ++i) {
        push.light = i;
        push.first = i == 0 ? 1 : 0;
        ImageId map;
        if (shadowed[i])
            map = addHairShadowPass(graph, buffers, "hair shadow " + std::to_string(i), lights[i],
                                    {.size = settings.shadowSize,
                                     .masks = i,
                                     .alpha = settings.alpha,
                                     .frame = settings.frameIndex});
        if (shadowed[i] && buffers.triangleCount > 0 && i < gpu::kHairSurfaceLights)
            addSurfaceShadowPass(graph, buffers, map, i, settings.shadowSize);
        PassBuilder pass = graph.addComputePass("hair shading " + std::to_string(i));
        const BufferId points = pass.read(graph.importBuffer(buffers.points));
        const BufferId tangents = pass.read(graph.importBuffer(buffers.tangents));
        const BufferId colors = pass.read(graph.importBuffer(buffers.colors));
        const BufferId table = pass.read(graph.importBuffer(buffers.lights));
        shaded = pass.write(shaded);
        const glm::uvec3 threads(buffers.pointCount, 1, 1);
        if (!shadowed[i]) {
            pass.dispatch(kernels::hair_shade, threads, push,
                          {points, tangents, colors, shaded, table});
            continue;
        }
        pass.sample(map);
        pass.dispatch(kernels::hair_shade_shadowed, threads, push,
                      {points, tangents, colors, shaded, table, Binding(map, Filter::Nearest)});
    }
    return shaded;
}

HairSampleIds addHairOccludersPass(RenderGraph& graph, HairBuffers& buffers, const HairView& view,
                                   const HairRenderSettings& settings, std::uint32_t lightCount,
                                   bool plainSurfaces)
{
    const ImageDesc desc{view.width, view.height, 1, Format::RGBA16F, 4};
    HairSampleIds ids;
    PassBuilder pass = graph.addRasterPass("hair occluders");
    const glm::vec3 clear = plainSurfaces ? settings.backgroundColor : glm::vec3(0.0f);
    if (plainSurfaces)
        ids.color = pass.color(graph.createImage("hair color", desc), {true, {clear, 0.0f}});
    ids.depth = pass.depth(graph.createImage("hair depth", desc.with(Format::Depth32F)));
    gpu::HairOpaquePush push = opaquePush(view);
    push.ambient = settings.distant ? glm::vec3(0.0f) : settings.ambient; // else a lobe
    push.lightCount = lightCount;
    push.lobeCount = settings.distant ? std::uint32_t(settings.distant->lobes.size()) : 0u;
    drawOpaque(graph, pass, buffers, push,
               plainSurfaces ? kernels::hair_opaque_frag : kernels::hair_depth_frag, Blend::None);
    return ids;
}

HairSampleIds addHairStrandsPass(RenderGraph& graph, HairBuffers& buffers, BufferId shaded,
                                 const HairView& view, const HairRenderSettings& settings,
                                 std::uint32_t lightCount, bool plainSurfaces, bool wantFeatures)
{
    const ImageDesc desc{view.width, view.height, 1, Format::RGBA16F, 4};
    HairSampleIds ids =
        addHairOccludersPass(graph, buffers, view, settings, lightCount, plainSurfaces);
    PassBuilder pass = graph.addRasterPass("hair strands");
    ids.color = plainSurfaces ? pass.color(ids.color, {false, {}})
                              : pass.color(graph.createImage("hair color", desc));
    if (wantFeatures) {
        ids.features = pass.color(graph.createImage("hair features", desc), {true, {0, 0, 1, 0}});
        ids.shape = pass.color(graph.createImage("hair shape", desc));
    }
    ids.depth = pass.depth(ids.depth, {false, glm::vec4(1.0f)});
    const StrandIds strands = readStrands(graph, pass, buffers);
    pass.read(shaded);
    const bool deviceMasks = settings.filter == HairFilter::AlphaToCoverage;
    const KernelBlob& plain = deviceMasks ? kernels::hair_alpha_frag : kernels::hair_color_frag;
    const RasterDesc raster{.vertex = &kernels::hair_strands_vert,
                            .fragment = wantFeatures ? &kernels::hair_features_frag : &plain,
                            .alphaToCoverage = deviceMasks && !wantFeatures};
    pass.draw(raster, buffers.segmentCount * 6, 1, strandPush(buffers, view),
              {strands.points, strands.tangents, strands.segments, shaded});
    return ids;
}

ImageId addHairBackdropPass(RenderGraph& graph, HairBuffers& buffers, const HairView& view,
                            const HairRenderSettings& settings, std::uint32_t lightCount,
                            ImageId radiance)
{
    const HairSampleIds ids =
        addHairOccludersPass(graph, buffers, view, settings, lightCount, true);
    PassBuilder pass = graph.addComputePass("hair backdrop");
    pass.sample(ids.color);
    radiance = pass.write(radiance);
    pass.dispatch(kernels::hair_backdrop, {view.width, view.height, 1},
                  gpu::HairResolvePush{view.width, view.height, 1.0f, 4},
                  {Binding(ids.color, Filter::Nearest), radiance});
    return radiance;
}

ImageId addHairCoveragePass(RenderGraph& graph, HairBuffers& buffers, const HairView& view)
{
    // Not R16F: near 1 it rounds by 2^-11, which is 2.5 % of a strand that covers 0.02.
    const ImageDesc desc{view.width, view.height, 1, Format::R32F, 1};
    PassBuilder pass = graph.addRasterPass("hair exact coverage");
    const ImageId product =
        pass.color(graph.createImage("hair transmittance", desc), {true, glm::vec4(1.0f)});
    [[maybe_unused]] const ImageId depth =
        pass.depth(graph.createImage("hair coverage depth", desc.with(Format::Depth32F)));
    drawOpaque(graph, pass, buffers, opaquePush(view), kernels::hair_unhidden_frag,
               Blend::Multiply);
    const StrandIds strands = readStrands(graph, pass, buffers);
    const RasterDesc raster{.vertex = &kernels::hair_coverage_vert,
                            .fragment = &kernels::hair_coverage_frag,
                            .depthWrite = false,
                            .blend = Blend::Multiply};
    pass.draw(raster, buffers.segmentCount * 6, 1, strandPush(buffers, view),
              {strands.points, strands.tangents, strands.segments});
    return product;
}

HairSums addHairResolvePass(RenderGraph& graph, const HairSampleIds& samples, HairSums sums,
                            float weight, std::uint32_t count)
{
    PassBuilder pass = graph.addComputePass("hair resolve");
    pass.sample(samples.color);
    sums.hair = pass.write(sums.hair);
    sums.behind = pass.write(sums.behind);
    const glm::uvec3 extent = graph.extent(samples.color);
    pass.dispatch(kernels::hair_resolve, extent,
                  gpu::HairResolvePush{extent.x, extent.y, weight, count},
                  {Binding(samples.color, Filter::Nearest), sums.hair, sums.behind});
    return sums;
}

ImageId addHairIlluminationPass(RenderGraph& graph, const HairSampleIds& samples, ImageId sum,
                                float weight)
{
    if (!samples.features.valid())
        throw Error("hair: the illumination needs strands drawn with features");
    PassBuilder pass = graph.addComputePass("hair illumination");
    pass.sample(samples.features);
    sum = pass.write(sum);
    const glm::uvec3 extent = graph.extent(samples.features);
    pass.dispatch(kernels::hair_illumination, extent,
                  gpu::HairResolvePush{extent.x, extent.y, weight},
                  {Binding(samples.features, Filter::Nearest), sum});
    return sum;
}

TensorDesc hairInputDesc(std::uint32_t width, std::uint32_t height)
{
    const auto padded = [](std::uint32_t side) { return (side + 7) / 8 * 8; };
    return {1, gpu::kHairInputPlanes, padded(height), padded(width)};
}

TensorId addHairInputPass(RenderGraph& graph, const HairSampleIds& samples, ImageId blended,
                          const HairDepthScale& depth, const TensorId& x, std::uint32_t firstRow,
                          const TileList* tiles)
{
    if (!samples.features.valid() || !samples.shape.valid())
        throw Error("hair: the network's input needs strands drawn with features");
    const glm::uvec3 extent = graph.extent(samples.features);
    const TensorDesc wanted = hairInputDesc(extent.x, extent.y);
    if (x.desc.n != 1 || x.desc.c != wanted.c || x.desc.w != wanted.w ||
        firstRow + x.desc.h > wanted.h)
        throw Error("hair: the network's input " + shapeText(x.desc) + " holds no rows of " +
                    shapeText(wanted));
    const KernelBlob& kernel =
        x.element == Element::Half ? kernels::hair_input_half : kernels::hair_input;
    PassBuilder pass = graph.addComputePass("hair network input");
    pass.sample(samples.features);
    pass.sample(samples.shape);
    pass.read(blended);
    const BufferId planes = pass.write(x.buffer);
    const gpu::HairInputPush push{x.view(),
                                  {firstRow, extent.x, extent.y, depth.offset, depth.scale}};
    const Binding features(samples.features, Filter::Nearest);
    const Binding shape(samples.shape, Filter::Nearest);
    if (tiles) {
        const BufferId list = pass.read(tiles->tiles);
        pass.dispatchIndirect(kernel, tiles->arguments, tileArguments(1, 1), push,
                              {features, shape, planes, list, blended}, {1});
    } else {
        const std::uint32_t none[] = {0};
        const BufferId list =
            pass.read(graph.uploadBuffer("no tiles", std::span<const std::uint32_t>(none)));
        pass.dispatch(kernel, {x.desc.w, x.desc.h, 1}, push,
                      {features, shape, planes, list, blended}, {0});
    }
    return x.as(planes);
}

} // namespace strandlight
