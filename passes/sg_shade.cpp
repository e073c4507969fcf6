#include "passes/sg_shade.hpp"

#include "kernels/sg.gen.hpp"
#include "shaders/shared/shade_types.h"

namespace strandlight {
namespace {

gpu::SgShadePush shadePush(const RenderGraph& graph, const GBufferIds& gbuffer,
                           const SgLobeIds& lobes, glm::vec3 eye)
{
    const glm::uvec3 extent = graph.extent(gbuffer.position);
    return {eye, extent.x, extent.y, lobes.resolution};
}

// The images that every shading pass reads.
void readGBuffer(PassBuilder& pass, const GBufferIds& gbuffer)
{
    for (const ImageId image :
         {gbuffer.position, gbuffer.frame, gbuffer.tangent, gbuffer.normal, gbuffer.specular})
        pass.read(image);
}

void readLobes(PassBuilder& pass, const SgLobeIds& lobes)
{
    pass.read(lobes.texels);
    pass.read(lobes.lobes);
}

} // namespace

ImageId addSgDiffusePass(RenderGraph& graph, std::string_view name, const GBufferIds& gbuffer,
                         const SgLobeIds& lobes, glm::vec3 eye, DiffuseModel model, ImageId lit)
{
    PassBuilder pass = graph.addComputePass(name);
    readGBuffer(pass, gbuffer);
    pass.read(gbuffer.diffuse);
    readLobes(pass, lobes);
    const ImageId out = pass.write(lit);
    pass.dispatch(kernels::sg_diffuse, graph.extent(out), shadePush(graph, gbuffer, lobes, eye),
                  {gbuffer.position, gbuffer.frame, gbuffer.tangent, gbuffer.normal,
                   gbuffer.diffuse, gbuffer.specular, lobes.texels, lobes.lobes, out},
                  {std::uint32_t(model)});
    return out;
}

ImageId addSgSpecularPass(RenderGraph& graph, const GBufferIds& gbuffer, const SgLobeIds& lobes,
                          ImageId table, glm::vec3 eye, SpecularModel model, ImageId lit)
{
    PassBuilder pass = graph.addComputePass("sg specular");
    readGBuffer(pass, gbuffer);
    pass.read(gbuffer.diffuse);
    readLobes(pass, lobes);
    pass.sample(table);
    const ImageId out = pass.write(lit);
    pass.dispatch(kernels::sg_specular, graph.extent(out), shadePush(graph, gbuffer, lobes, eye),
                  {gbuffer.position, gbuffer.frame, gbuffer.tangent, gbuffer.normal,
                   gbuffer.diffuse, gbuffer.specular, lobes.texels, lobes.lobes, table, out},
                  {std::uint32_t(model)});
    return out;
}

ImageId addSgEnvironmentPass(RenderGraph& graph, const GBufferIds& gbuffer, const SgLobeIds& lobes,
                             ImageId table, const EnvironmentIds& environment, glm::vec3 eye,
                             SpecularModel model, ImageId lit)
{
    PassBuilder pass = graph.addComputePass("sg environment");
    readGBuffer(pass, gbuffer);
    pass.read(gbuffer.diffuse);
    readLobes(pass, lobes);
    pass.sample(table);
    pass.read(environment.pyramid);
    pass.read(environment.prefiltered);
    const ImageId out = pass.write(lit);
    const glm::uvec3 extent = graph.extent(out);
    const gpu::SgEnvironmentPush push{eye, extent.x, extent.y, lobes.resolution, environment.shape};
    pass.dispatch(kernels::sg_environment, extent, push,
                  {gbuffer.position, gbuffer.frame, gbuffer.tangent, gbuffer.normal,
                   gbuffer.diffuse, gbuffer.specular, lobes.texels, lobes.lobes, table,
                   environment.pyramid, environment.prefiltered, out},
                  {std::uint32_t(model)});
    return out;
}

ImageId addSgViewPass(RenderGraph& graph, const GBufferIds& gbuffer, const SgLobeIds& lobes,
                      glm::vec3 eye, std::uint32_t view, ImageId lit)
{
    PassBuilder pass = graph.addComputePass(view == gpu::kViewAtlas   ? "view atlas"
                                            : view == gpu::kViewCount ? "view count"
                                                                      : "view lobes");
    readGBuffer(pass, gbuffer);
    readLobes(pass, lobes);
    const ImageId out = pass.write(lit);
    pass.dispatch(kernels::sg_view, graph.extent(out), shadePush(graph, gbuffer, lobes, eye),
                  {gbuffer.position, gbuffer.frame, gbuffer.tangent, gbuffer.normal,
                   gbuffer.specular, lobes.texels, lobes.lobes, out},
                  {view});
    return out;
}

} // namespace strandlight
