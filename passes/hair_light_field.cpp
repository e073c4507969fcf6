// A bake's light field where hair is, as a picture of all directions.
#include <algorithm>
#include <cmath>
#include <vector>

#include "passes/hair_distant.hpp"
#include "shaders/shared/environment.h"
#include "shaders/shared/sg.h"

namespace strandlight {
namespace {

struct NearTexel
{
    std::size_t index;
    AtlasPoint point;
    float weight; // by distance
};

// The 16 nearest facing each axis, beyond the radius.
std::vector<NearTexel> nearTexels(const Scene& scene, const Atlas& atlas, glm::vec3 place,
                                  float radius)
{
    constexpr std::size_t kNearest = 16;
    std::vector<NearTexel> sides[6];
    for (std::size_t i = 0; i < atlas.texels.size(); ++i) {
        const AtlasPoint point = evaluateAtlasTexel(scene, atlas, atlas.texels[i]);
        const glm::vec3 size = glm::abs(point.n);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const glm::vec3 path = point.position - place;
        // A texel knows the light on its own side.
        if (glm::dot(path, point.n) >= 0.0f || glm::dot(path, path) < radius * radius)
            continue;
        const float weight = 1.0f / (0.01f + glm::dot(path, path));
        sides[2 * axis + (point.n[axis] > 0.0f ? 1 : 0)].push_back({i, point, weight});
    }
    std::vector<NearTexel> nearest;
    for (std::vector<NearTexel>& side : sides) {
        const std::size_t count = std::min(side.size(), kNearest);
        std::partial_sort(side.begin(), side.begin() + std::ptrdiff_t(count), side.end(),
                          [](const NearTexel& a, const NearTexel& b) {
                              return a.weight != b.weight ? a.weight > b.weight : a.index < b.index;
                          });
        nearest.insert(nearest.end(), side.begin(), side.begin() + std::ptrdiff_t(count));
    }
    return nearest;
}

glm::vec3 lobesRadiance(const SgField& field, std::size_t texel, glm::vec3 local)
{
    glm::vec3 sum(0.0f);
    const std::uint32_t kept = field.keptBy(texel);
    for (std::uint32_t k = 0; k < field.lobeCount; ++k) {
        if ((kept >> k & 1u) == 0u)
            continue;
        const SgLobe& lobe = field.lobes[texel * field.lobeCount + k];
        sum += lobe.amplitude * gpu::sgEvaluate(local, lobe.axis, std::exp(lobe.logSharpness));
    }
    return sum;
}

} // namespace

Environment lightFieldAt(const Scene& scene, const SgBake& bake, glm::vec3 place, float radius)
{
    std::vector<NearTexel> texels = nearTexels(scene, bake.atlas, place, radius);
    if (texels.empty())
        texels = nearTexels(scene, bake.atlas, place, 0.0f);
    Environment result{CpuImage(64, 32)};
    CpuImage& picture = result.latLong;
    glm::dvec4 known(0.0);
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const glm::vec3 d =
                gpu::environmentDirection((float(x) + 0.5f) / float(picture.width),
                                          (float(y) + 0.5f) / float(picture.height));
            glm::vec4 sum(0.0f);
            for (const NearTexel& texel : texels) {
                const AtlasPoint& p = texel.point;
                const float weight = texel.weight * std::max(glm::dot(p.n, d), 0.0f);
                if (!(weight > 0.0f))
                    continue;
                const glm::vec3 local(glm::dot(p.t, d), glm::dot(p.b, d), glm::dot(p.n, d));
                glm::vec3 radiance = lobesRadiance(bake.radiance, texel.index, local);
                if (bake.environment)
                    radiance += lobesRadiance(*bake.environment, texel.index, local);
                sum += weight * glm::vec4(glm::max(radiance, 0.0f), 1.0f);
            }
            glm::vec4& pixel = picture.at(x, y);
            pixel = sum.w > 0.0f ? sum / sum.w : glm::vec4(0.0f);
            known += double(std::sin(M_PI * (y + 0.5) / picture.height)) * glm::dvec4(pixel);
        }
    const glm::vec3 ground =
        known.w > 0.0 ? glm::vec3(known) * float(0.5 / known.w) : glm::vec3(0.0f);
    for (glm::vec4& pixel : picture.pixels)
        if (pixel.w == 0.0f)
            pixel = glm::vec4(ground, 1.0f);
    return result;
}

} // namespace strandlight
