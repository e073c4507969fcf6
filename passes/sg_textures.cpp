#include "passes/sg_textures.hpp"

#include <algorithm>
#include <bit>
#include <string>

#include <glm/gtc/packing.hpp>

#include "engine/base/error.hpp"
#include "shaders/shared/shade_types.h"

namespace strandlight {
namespace {

constexpr float kLargestHalf = 65504.0f;

void checkField(const SgField& field, std::size_t texels, const char* name)
{
    if (field.lobeCount == 0 || field.lobeCount > kMaximumLobes ||
        field.lobes.size() != texels * field.lobeCount ||
        (!field.kept.empty() && field.kept.size() != texels))
        throw Error("bake: the " + std::string(name) + " field has " +
                    std::to_string(field.lobes.size()) + " lobes and " +
                    std::to_string(field.kept.size()) + " masks, the atlas has " +
                    std::to_string(texels) + " texels of " + std::to_string(field.lobeCount));
}

std::vector<glm::uvec4> packKeptLobes(const SgField& field)
{
    std::vector<glm::uvec4> packed;
    packed.reserve(field.keptCount());
    for (std::size_t i = 0; i < field.lobes.size(); ++i)
        if ((field.keptBy(i / field.lobeCount) >> (i % field.lobeCount) & 1u) != 0u)
            packed.push_back(packSgLobe(field.lobes[i]));
    return packed;
}

std::vector<glm::uvec2> indexTexels(const Atlas& atlas, const SgField& field)
{
    std::vector<glm::uvec2> index(std::size_t(atlas.resolution) * atlas.resolution,
                                  glm::uvec2(gpu::kNoTexel, 0u));
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < atlas.texels.size(); ++i) {
        const AtlasTexel& texel = atlas.texels[i];
        if (texel.x >= atlas.resolution || texel.y >= atlas.resolution)
            throw Error("bake: texel (" + std::to_string(texel.x) + ", " + std::to_string(texel.y) +
                        ") lies outside the atlas of " + std::to_string(atlas.resolution));
        const std::uint32_t mask = field.keptBy(i);
        index[std::size_t(texel.y) * atlas.resolution + texel.x] = {first, mask};
        first += std::uint32_t(std::popcount(mask));
    }
    return index;
}

SgLobeBuffers uploadLobes(Context& context, const Atlas& atlas, const SgField& field,
                          const char* name)
{
    checkField(field, atlas.texels.size(), name);
    const std::vector<glm::uvec4> packed = packKeptLobes(field);
    const std::uint64_t bytes = packed.size() * sizeof(glm::uvec4);
    if (bytes > context.maxStorageBufferBytes())
        throw Error("bake: the " + std::string(name) + " lobes take " + std::to_string(bytes) +
                    " bytes, one binding of this device holds " +
                    std::to_string(context.maxStorageBufferBytes()) +
                    "; use a smaller atlas or fewer lobes");
    SgLobeBuffers buffers;
    buffers.texels =
        Buffer::from(context, indexTexels(atlas, field), std::string("sg texels ") + name);
    if (!packed.empty())
        buffers.lobes = Buffer::from(context, packed, std::string("sg lobes ") + name);
    return buffers;
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
    SgTextures textures;
    textures.resolution = bake.atlas.resolution;
    textures.corners = Buffer::from(context, packCorners(bake.atlas), "atlas corners");
    textures.radiance = uploadLobes(context, bake.atlas, bake.radiance, "radiance");
    if (bake.environment && bake.environment->keptCount() > 0)
        textures.environment = uploadLobes(context, bake.atlas, *bake.environment, "environment");
    return textures;
}

SgLobeIds importLobes(RenderGraph& graph, SgLobeBuffers& lobes, std::uint32_t resolution)
{
    // A binding cannot stay empty: what is not read may be any buffer.
    const BufferId texels = graph.importBuffer(lobes.texels);
    return {texels, lobes.lobes.valid() ? graph.importBuffer(lobes.lobes) : texels, resolution};
}

} // namespace strandlight
