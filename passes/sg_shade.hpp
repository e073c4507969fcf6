// Light from the bake onto the G-buffer. Each pass adds to `lit` (linear radiance, RGBA32F) and
// returns its next version; a scene gets only the passes that it needs.
#pragma once

#include <string_view>

#include <glm/glm.hpp>

#include "engine/graph/render_graph.hpp"
#include "passes/environment_prefilter.hpp"
#include "passes/gbuffer.hpp"
#include "passes/sg_textures.hpp"

namespace strandlight {

// How a GGX lobe meets a light lobe; shaders/shared/sg_specular.h has the measured errors.
enum class SpecularModel : std::uint32_t
{
    Mixture = gpu::kSpecularMixture,    // four fitted SGs times the cosine: the default
    Asg = gpu::kSpecularAsg,            // the thesis's
    NdfFilter = gpu::kSpecularNdfFilter // Tokuyoshi 2024
};

// The clamped-cosine integral of a lobe; shaders/shared/sg_diffuse.h has the measured errors.
enum class DiffuseModel : std::uint32_t
{
    Tokuyoshi = gpu::kDiffuseTokuyoshi, // 2024: the default
    Hill = gpu::kDiffuseHill,           // wrong for lobes of sharpness below 1
    Wang = gpu::kDiffuseWang            // the cosine as a lobe
};

// Irradiance of the lobes on the Lambert part.
ImageId addSgDiffusePass(RenderGraph& graph, std::string_view name, const GBufferIds& gbuffer,
                         const SgLobeIds& lobes, glm::vec3 eye, DiffuseModel model, ImageId lit);

// Their glossy reflection. `table`: uploadSpecularTable().
ImageId addSgSpecularPass(RenderGraph& graph, const GBufferIds& gbuffer, const SgLobeIds& lobes,
                          ImageId table, glm::vec3 eye, SpecularModel model, ImageId lit);

// Glossy reflection of the distant environment, by the ratio of the second lobe set to the
// unoccluded environment.
ImageId addSgEnvironmentPass(RenderGraph& graph, const GBufferIds& gbuffer, const SgLobeIds& lobes,
                             ImageId table, const EnvironmentIds& environment, glm::vec3 eye,
                             SpecularModel model, ImageId lit);

// `view`: kViewLobes (the light field in a perfect mirror), kViewAtlas (its texels) or kViewCount
// (how many lobes shading loops over).
ImageId addSgViewPass(RenderGraph& graph, const GBufferIds& gbuffer, const SgLobeIds& lobes,
                      glm::vec3 eye, std::uint32_t view, ImageId lit);

} // namespace strandlight
