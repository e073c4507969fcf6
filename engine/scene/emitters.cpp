#include "engine/scene/emitters.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/error.hpp"
#include "shaders/shared/light_types.h"
#include "shaders/shared/sampling.h"

namespace strandlight {
namespace {

constexpr double kPi = 3.141592653589793;

// Mean emitted radiance over a triangle. Sixteen points find every texture detail that matters for
// choosing; what they miss is still found by surface sampling, with full weight.
glm::vec3 averageEmission(const Scene& scene, std::uint32_t triangle,
                          const gpu::GpuMaterial& material, const TexturePool& textures)
{
    if (scene.materials[scene.triangleMaterials[triangle]].emissiveTexture.texture < 0)
        return material.emissive;
    const glm::uvec3 t = scene.triangles[triangle];
    const Vertex& a = scene.vertices[t.x];
    const Vertex& b = scene.vertices[t.y];
    const Vertex& c = scene.vertices[t.z];
    glm::vec3 sum(0.0f);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            const glm::vec2 w =
                gpu::sampleTriangle((float(i) + 0.5f) / 4.0f, (float(j) + 0.5f) / 4.0f);
            const glm::vec2 uv0 = a.uv0 * (1.0f - w.x - w.y) + b.uv0 * w.x + c.uv0 * w.y;
            const glm::vec2 uv1 = a.uv1 * (1.0f - w.x - w.y) + b.uv1 * w.x + c.uv1 * w.y;
            sum += evaluateMaterial(textures, material, uv0, uv1, kFullResolution).emissive;
        }
    return sum / 16.0f;
}

// Mean luminance over a texel's area of what bilinear lookups see there: 1/8, 3/4, 1/8 along each
// axis. A bright texel thus raises its neighbours, into which it bleeds; else they would be rare
// and bright samples.
double meanOverTexel(const CpuImage& image, std::uint32_t x, std::uint32_t y)
{
    const std::uint32_t columns[3] = {x == 0 ? image.width - 1 : x - 1, x,
                                      x + 1 == image.width ? 0 : x + 1};
    const std::uint32_t rows[3] = {y == 0 ? 0 : y - 1, y, y + 1 == image.height ? y : y + 1};
    const double tap[3] = {0.125, 0.75, 0.125};
    double sum = 0.0;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            sum +=
                tap[i] * tap[j] * double(gpu::luminance(glm::vec3(image.at(columns[i], rows[j]))));
    return sum;
}

double punctualPower(const PunctualLight& light, double sceneRadius)
{
    const double intensity = gpu::luminance(light.intensity);
    if (light.type == LightType::Directional)
        return intensity * kPi * sceneRadius * sceneRadius;
    return intensity * 4.0 * kPi;
}

} // namespace

AliasTable buildAliasTable(const std::vector<double>& weights)
{
    double total = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (!std::isfinite(weights[i]) || weights[i] < 0.0)
            throw Error("alias table: weight " + std::to_string(i) + " is " +
                        std::to_string(weights[i]));
        total += weights[i];
    }
    if (!(total > 0.0) || !std::isfinite(total))
        throw Error("alias table: the weights add up to " + std::to_string(total));

    const std::size_t n = weights.size();
    AliasTable table;
    table.thresholds.assign(n, 1.0f);
    table.others.resize(n);
    table.probabilities.resize(n);
    std::vector<double> scaled(n);
    std::vector<std::uint32_t> small;
    std::vector<std::uint32_t> large;
    for (std::size_t i = 0; i < n; ++i) {
        table.others[i] = std::uint32_t(i);
        table.probabilities[i] = float(weights[i] / total);
        scaled[i] = weights[i] / total * double(n);
        (scaled[i] < 1.0 ? small : large).push_back(std::uint32_t(i));
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t s = small.back();
        const std::uint32_t l = large.back();
        small.pop_back();
        table.thresholds[s] = float(scaled[s]);
        table.others[s] = l;
        scaled[l] -= 1.0 - scaled[s];
        if (scaled[l] < 1.0) {
            large.pop_back();
            small.push_back(l);
        }
    }
    return table;
}

EmitterTable buildEmitterTable(const Scene& scene, const Bvh& bvh, const TexturePool& textures)
{
    const std::vector<gpu::GpuMaterial> materials = packMaterials(scene);
    EmitterTable table;
    table.triangleDensity.assign(bvh.order.size(), 0.0f);
    std::vector<double> weights;
    std::vector<std::uint32_t> targets;
    std::vector<double> areas;
    for (std::uint32_t slot = 0; slot < bvh.order.size(); ++slot) {
        const std::uint32_t triangle = bvh.order[slot];
        const std::uint32_t material = scene.triangleMaterials[triangle];
        if (scene.materials[material].emissive == glm::vec3(0.0f))
            continue;
        const glm::vec3 emission = averageEmission(scene, triangle, materials[material], textures);
        const TriangleCorners corners = triangleCorners(bvh, slot);
        const double area =
            0.5 * glm::length(glm::cross(glm::dvec3(corners.b) - glm::dvec3(corners.a),
                                         glm::dvec3(corners.c) - glm::dvec3(corners.a)));
        const double sides = scene.materials[material].doubleSided ? 2.0 : 1.0;
        const double power = area * kPi * sides * double(gpu::luminance(emission));
        if (!(power > 0.0))
            continue;
        weights.push_back(power);
        targets.push_back(slot);
        areas.push_back(area);
    }
    const double radius = scene.vertices.empty()
                              ? 1.0
                              : 0.5 * double(glm::length(scene.boundsMax() - scene.boundsMin()));
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
        const double power = punctualPower(scene.lights[i], radius);
        if (!(power > 0.0))
            continue;
        weights.push_back(power);
        targets.push_back(gpu::kPunctualBit | i);
        areas.push_back(1.0);
    }
    if (weights.empty())
        return table;

    const AliasTable alias = buildAliasTable(weights);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        table.entries.push_back(glm::uvec4(glm::floatBitsToUint(alias.thresholds[i]),
                                           alias.others[i], targets[i],
                                           glm::floatBitsToUint(alias.probabilities[i])));
        if ((targets[i] & gpu::kPunctualBit) == 0u)
            table.triangleDensity[targets[i]] = float(double(alias.probabilities[i]) / areas[i]);
    }
    return table;
}

EnvironmentGrid buildEnvironmentGrid(const Environment& environment)
{
    const CpuImage& image = environment.latLong;
    EnvironmentGrid grid;
    grid.width = std::min(image.width, 512u);
    grid.height = std::min(image.height, 256u);
    std::vector<double> weights(std::size_t(grid.width) * grid.height, 0.0);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        const double sine = std::sin((double(y) + 0.5) / image.height * kPi);
        const std::size_t row =
            std::size_t(std::uint64_t(y) * grid.height / image.height) * grid.width;
        for (std::uint32_t x = 0; x < image.width; ++x)
            weights[row + std::size_t(std::uint64_t(x) * grid.width / image.width)] +=
                sine * meanOverTexel(image, x, y);
    }
    const AliasTable alias = buildAliasTable(weights);
    const float cells = float(weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i)
        grid.cells.push_back(glm::vec4(alias.thresholds[i], float(alias.others[i]),
                                       alias.probabilities[i] * cells, 0.0f));
    return grid;
}

} // namespace strandlight
