#include "passes/sg_textures.hpp"

#include <algorithm>
#include <string>

#include <glm/gtc/packing.hpp>

#include "engine/base/error.hpp"
#include "shaders/shared/shade_types.h"

namespace strandlight {
namespace {

constexpr float kLargestHalf = 65504.0f;

std::vector<glm::uvec4> packField(const SgField& field, std::size_t texels, const char* name)
{
    if (field.lobeCount == 0 || field.lobes.size() != texels * field.lobeCount)
        throw Error("bake: the " + std::string(name) + " field has " +
                    std::to_string(field.lobes.size()) + " lobes, the atlas has " +
                    std::to_string(texels) + " texels of " + std::to_string(field.lobeCount));
    std::vector<glm::uvec4> packed;
    packed.reserve(field.lobes.size());
    for (const SgLobe& lobe : field.lobes)
        packed.push_back(packSgLobe(lobe));
    return packed;
}

Buffer uploadLobes(Context& context, const SgField& field, std::size_t texels, const char* name)
{
    const std::vector<glm::uvec4> packed = packField(field, texels, name);
    const std::uint64_t bytes = packed.size() * sizeof(glm::uvec4);
    if (bytes > context.maxStorageBufferBytes())
        throw Error("bake: the " + std::string(name) + " lobes take " + std::to_string(bytes) +
                    " bytes, one binding of this device holds " +
                    std::to_string(context.maxStorageBufferBytes()) +
                    "; use a smaller atlas or fewer lobes");
    return Buffer::from(context, packed, std::string("sg lobes ") + name);
}

std::vector<std::uint32_t> indexTexels(const Atlas& atlas)
{
    std::vector<std::uint32_t> index(std::size_t(atlas.resolution) * atlas.resolution,
                                     gpu::kNoTexel);
    for (std::size_t i = 0; i < atlas.texels.size(); ++i) {
        const AtlasTexel& texel = atlas.texels[i];
        if (texel.x >= atlas.resolution || texel.y >= atlas.resolution)
            throw Error("bake: texel (" + std::to_string(texel.x) + ", " + std::to_string(texel.y) +
                        ") lies outside the atlas of " + std::to_string(atlas.resolution));
        index[std::size_t(texel.y) * atlas.resolution + texel.x] = std::uint32_t(i);
    }
    return index;
}

std::vector<glm::vec4> packCorners(const Atlas& atlas)
{
    std::vector<glm::vec4> packed;
    packed.reserve(atlas.corners.size() / 3 * 4);
    for (std::size_t i = 0; i + 2 < atlas.corners.size(); i += 3) {
        glm::vec4 rows(0.0f);
        for (int k = 0; k < 3; ++k) {
            packed.push_back(glm::vec4(atlas.corners[i + k].tangent, atlas.corners[i + k].uv.x));
            rows[k] = atlas.corners[i + k].uv.y;
        }
        packed.push_back(rows);
    }
    return packed;
}

} // namespace

glm::uvec4 packSgLobe(const SgLobe& lobe)
{
    const glm::vec3 a = glm::clamp(lobe.amplitude, -kLargestHalf, kLargestHalf);
    return {glm::packHalf2x16({lobe.axis.x, lobe.axis.y}),
            glm::packHalf2x16({lobe.axis.z, lobe.logSharpness}), glm::packHalf2x16({a.x, a.y}),
            glm::packHalf2x16({a.z, 0.0f})};
}

SgTextures uploadSgTextures(Context& context, const SgBake& bake)
{
    const std::size_t texels = bake.atlas.texels.size();
    SgTextures textures;
    textures.resolution = bake.atlas.resolution;
    textures.texelIndex = Buffer::from(context, indexTexels(bake.atlas), "sg texel index");
    textures.corners = Buffer::from(context, packCorners(bake.atlas), "atlas corners");
    textures.radiance = uploadLobes(context, bake.radiance, texels, "radiance");
    textures.radianceLobes = bake.radiance.lobeCount;
    if (bake.environment) {
        textures.environment = uploadLobes(context, *bake.environment, texels, "environment");
        textures.environmentLobes = bake.environment->lobeCount;
    }
    return textures;
}

SgLobeIds importRadianceLobes(RenderGraph& graph, SgTextures& textures)
{
    return {graph.importBuffer(textures.texelIndex), graph.importBuffer(textures.radiance),
            textures.resolution, textures.radianceLobes};
}

SgLobeIds importEnvironmentLobes(RenderGraph& graph, SgTextures& textures)
{
    return {graph.importBuffer(textures.texelIndex), graph.importBuffer(textures.environment),
            textures.resolution, textures.environmentLobes};
}

} // namespace strandlight
