#include "passes/cpu_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/scene/camera.hpp"
#include "engine/scene/environment.hpp"
#include "shaders/shared/brdf.h"
#include "shaders/shared/rng.h"

namespace strandlight {
namespace {

constexpr std::uint32_t kMaskLayers = 16;
constexpr std::uint32_t kRouletteBounce = 5;
constexpr float kFar = 1e30f;

struct Shading
{
    glm::vec3 position;
    glm::vec3 geometric; // towards the viewer
    glm::vec3 normal;
    glm::vec3 axisX;
    glm::vec3 axisY;
    gpu::Surface surface;

    glm::vec3 toLocal(glm::vec3 d) const
    {
        return {glm::dot(d, axisX), glm::dot(d, axisY), glm::dot(d, normal)};
    }
    glm::vec3 toWorld(glm::vec3 d) const { return axisX * d.x + axisY * d.y + normal * d.z; }
};

struct LightSample
{
    glm::vec3 direction{0.0f};
    float distance = 0.0f;
    glm::vec3 radiance{0.0f};
    float pdf = 0.0f;
    bool delta = false;
};

class Tracer
{
public:
    Tracer(const Scene& scene, const ReferenceSettings& settings)
        : scene_(scene), traced_(prepareScene(scene)), settings_(settings)
    {
    }

    glm::vec3 radiance(glm::vec3 origin, glm::vec3 direction, std::uint32_t item,
                       std::uint32_t sample);

private:
    struct Corner
    {
        const Vertex* a;
        const Vertex* b;
        const Vertex* c;
        std::uint32_t material;
        float density; // of light sampling, 1/m^2
    };
    Corner cornersOf(std::uint32_t slot) const;
    template <class T> static T blend(T a, T b, T c, float u, float v)
    {
        return a * (1.0f - u - v) + b * u + c * v;
    }
    SurfaceMaterial materialAt(const Corner& t, float u, float v) const;
    gpu::Hit nearest(glm::vec3 origin, glm::vec3 direction, float tMax) const;
    Shading shadingAt(const gpu::Hit& hit, glm::vec3 direction) const;
    glm::vec3 environmentAt(glm::vec3 direction, float pathPdf, bool primary) const;
    LightSample sampleLight(glm::vec3 position, glm::vec3 uniforms, float choice) const;

    float environmentChoice() const { return glm::uintBitsToFloat(traced_.lightTable[0].y); }
    bool has(std::uint32_t feature) const { return (traced_.features & feature) != 0u; }
    // Density over solid angle of a cell of the environment's importance grid.
    float environmentPdf(float density, glm::vec3 direction) const
    {
        const float sine = std::sqrt(std::max(1.0f - direction.y * direction.y, 0.0f));
        return sine > 1e-6f ? density / (2.0f * gpu::kPi * gpu::kPi * sine) : 0.0f;
    }
    const glm::vec4& environmentCell(std::uint32_t index) const
    {
        const glm::uvec4 size = traced_.lightTable[1];
        return traced_.environment[std::size_t(size.x) * size.y + index];
    }

    const Scene& scene_;
    TracedScene traced_;
    ReferenceSettings settings_;
};

Tracer::Corner Tracer::cornersOf(std::uint32_t slot) const
{
    const std::uint32_t triangle = traced_.bvh.order[slot];
    const glm::uvec3 t = scene_.triangles[triangle];
    return {&scene_.vertices[t.x], &scene_.vertices[t.y], &scene_.vertices[t.z],
            scene_.triangleMaterials[triangle],
            glm::uintBitsToFloat(traced_.bvh.triangles[std::size_t(slot) * 3 + 2].w)};
}

SurfaceMaterial Tracer::materialAt(const Corner& t, float u, float v) const
{
    return evaluateMaterial(traced_.textures, traced_.materials[t.material],
                            blend(t.a->uv0, t.b->uv0, t.c->uv0, u, v),
                            blend(t.a->uv1, t.b->uv1, t.c->uv1, u, v), kFullResolution);
}

// The nearest surface that its alpha mask does not cut away.
gpu::Hit Tracer::nearest(glm::vec3 origin, glm::vec3 direction, float tMax) const
{
    float tMin = 0.0f;
    gpu::Hit hit{};
    for (std::uint32_t layer = 0; layer < kMaskLayers; ++layer) {
        hit = gpu::traverse(traced_.bvh.view(), traced_.bvh.grid, origin, direction, tMin, tMax,
                            false);
        if (hit.slot == gpu::kNoHit)
            break;
        const SurfaceMaterial m = materialAt(cornersOf(hit.slot), hit.u, hit.v);
        if (m.alphaCutoff < 0.0f || m.alpha >= m.alphaCutoff)
            break;
        tMin = hit.t;
    }
    return hit;
}

Shading Tracer::shadingAt(const gpu::Hit& hit, glm::vec3 direction) const
{
    const Corner t = cornersOf(hit.slot);
    Shading s;
    s.position = blend(t.a->position, t.b->position, t.c->position, hit.u, hit.v);
    s.geometric =
        glm::normalize(glm::cross(t.b->position - t.a->position, t.c->position - t.a->position));
    if (glm::dot(s.geometric, direction) >= 0.0f)
        s.geometric = -s.geometric;

    const SurfaceMaterial m = materialAt(t, hit.u, hit.v);
    s.surface = gpu::makeSurface(m.baseColor, m.metallic, m.roughness, m.specular, m.specularColor);
    glm::vec3 normal = blend(t.a->normal, t.b->normal, t.c->normal, hit.u, hit.v);
    if (has(gpu::kFeatureNormalTexture)) {
        const glm::vec3 n = glm::normalize(normal);
        glm::vec3 tangent = blend(glm::vec3(t.a->tangent), glm::vec3(t.b->tangent),
                                  glm::vec3(t.c->tangent), hit.u, hit.v);
        tangent = glm::normalize(tangent - n * glm::dot(n, tangent));
        const glm::vec3 bitangent = glm::cross(n, tangent) * (t.a->tangent.w < 0.0f ? -1.0f : 1.0f);
        normal = tangent * m.normal.x + bitangent * m.normal.y + n * m.normal.z;
    }
    if (glm::dot(normal, s.geometric) < 0.0f)
        normal = -normal;
    const float squared = glm::dot(normal, normal);
    s.normal = squared > 1e-12f && glm::dot(normal, direction) < 0.0f ? normal / std::sqrt(squared)
                                                                      : s.geometric;
    gpu::buildBasis(s.normal, s.axisX, s.axisY);
    return s;
}

glm::vec3 Tracer::environmentAt(glm::vec3 direction, float pathPdf, bool primary) const
{
    const glm::vec3 radiance = environmentRadiance(*scene_.environment, direction);
    if (primary)
        return radiance;
    const glm::uvec4 header = traced_.lightTable[0];
    const glm::vec2 uv = gpu::environmentUv(direction);
    const auto x = std::min(std::uint32_t(uv.x * float(header.z)), header.z - 1);
    const auto y = std::min(std::uint32_t(uv.y * float(header.w)), header.w - 1);
    const float density = environmentCell(y * header.z + x).z;
    return radiance *
           gpu::powerHeuristic(pathPdf, environmentChoice() * environmentPdf(density, direction));
}

LightSample Tracer::sampleLight(glm::vec3 position, glm::vec3 uniforms, float choice) const
{
    const glm::uvec4 header = traced_.lightTable[0];
    LightSample light;
    if (has(gpu::kFeatureEnvironment) && choice < environmentChoice()) {
        const gpu::AliasDraw draw = gpu::drawAlias(uniforms.z, header.z * header.w);
        std::uint32_t index = draw.column;
        if (draw.rest >= environmentCell(index).x)
            index = std::uint32_t(environmentCell(index).y);
        const float u = (float(index % header.z) + uniforms.x) / float(header.z);
        const float v = (float(index / header.z) + uniforms.y) / float(header.w);
        light.direction = gpu::environmentDirection(u, v);
        light.distance = kFar;
        light.radiance = environmentRadiance(*scene_.environment, light.direction);
        light.pdf = environmentChoice() * environmentPdf(environmentCell(index).z, light.direction);
        return light;
    }

    const gpu::AliasDraw draw = gpu::drawAlias(uniforms.z, header.x);
    glm::uvec4 entry = traced_.lightTable[gpu::kLightTableHeader + draw.column];
    if (draw.rest >= glm::uintBitsToFloat(entry.x))
        entry = traced_.lightTable[gpu::kLightTableHeader + entry.y];
    const float probability = 1.0f - environmentChoice();
    if ((entry.z & gpu::kPunctualBit) != 0u) {
        light.radiance = gpu::punctualIrradiance(traced_.lights[entry.z & ~gpu::kPunctualBit],
                                                 position, light.direction, light.distance);
        light.pdf = probability * glm::uintBitsToFloat(entry.w);
        light.delta = true;
        return light;
    }
    const Corner t = cornersOf(entry.z);
    const glm::vec2 w = gpu::sampleTriangle(uniforms.x, uniforms.y);
    const glm::vec3 offset =
        blend(t.a->position, t.b->position, t.c->position, w.x, w.y) - position;
    const glm::vec3 normal =
        glm::normalize(glm::cross(t.b->position - t.a->position, t.c->position - t.a->position));
    light.distance = glm::length(offset);
    light.direction = offset / light.distance;
    const float cosine = -glm::dot(normal, light.direction);
    const SurfaceMaterial m = materialAt(t, w.x, w.y);
    if (cosine > 0.0f || m.doubleSided)
        light.radiance = m.emissive;
    if (std::abs(cosine) > 1e-9f)
        light.pdf = probability * t.density * light.distance * light.distance / std::abs(cosine);
    return light;
}

glm::vec3 Tracer::radiance(glm::vec3 origin, glm::vec3 direction, std::uint32_t item,
                           std::uint32_t sample)
{
    glm::vec3 result(0.0f);
    glm::vec3 throughput(1.0f);
    float pdf = 0.0f;
    for (std::uint32_t bounce = 0;; ++bounce) {
        const gpu::Hit hit = nearest(origin, direction, kFar);
        if (hit.slot == gpu::kNoHit) {
            if (scene_.environment)
                result += throughput * environmentAt(direction, pdf, bounce == 0);
            return result;
        }
        const Corner t = cornersOf(hit.slot);
        const SurfaceMaterial material = materialAt(t, hit.u, hit.v);
        const glm::vec3 outward = glm::normalize(
            glm::cross(t.b->position - t.a->position, t.c->position - t.a->position));
        const float facing = -glm::dot(outward, direction);
        if (facing > 0.0f || material.doubleSided) {
            const float lightPdf = (1.0f - environmentChoice()) * t.density * hit.t * hit.t /
                                   std::max(std::abs(facing), 1e-9f);
            const float weight = bounce == 0 ? 1.0f : gpu::powerHeuristic(pdf, lightPdf);
            result += throughput * material.emissive * weight;
        }
        if (bounce >= settings_.bounces)
            return result;

        const Shading s = shadingAt(hit, direction);
        const glm::vec3 view = s.toLocal(-direction);
        origin = gpu::offsetOrigin(traced_.bvh.grid, s.position, s.geometric);
        const std::uint32_t dimension = 1 + bounce * 3;
        const auto draw = [&](std::uint32_t k) {
            return gpu::uniform3(item, sample, dimension + k, settings_.seed);
        };

        // Light that arrives straight from a source.
        if (has(gpu::kFeatureEmitters) || scene_.environment) {
            const LightSample light = sampleLight(origin, draw(1), draw(2).x);
            const gpu::BrdfValue f = gpu::evaluateBrdf(s.surface, view, s.toLocal(light.direction));
            const float reach = light.distance * (1.0f - 1e-4f) - traced_.bvh.grid.rayOffset;
            const bool useful =
                light.pdf > gpu::kSmallestPdf && glm::dot(light.direction, s.geometric) > 0.0f &&
                gpu::luminance(f.value) > 0.0f && gpu::luminance(light.radiance) > 0.0f;
            if (useful && nearest(origin, light.direction, reach).slot == gpu::kNoHit) {
                const float weight = light.delta ? 1.0f : gpu::powerHeuristic(light.pdf, f.pdf);
                result += throughput * f.value * light.radiance * (weight / light.pdf);
            }
        }

        // On with the path.
        const glm::vec3 local = gpu::sampleBrdf(s.surface, view, draw(0));
        const gpu::BrdfValue f = gpu::evaluateBrdf(s.surface, view, local);
        direction = glm::normalize(s.toWorld(local));
        if (!(f.pdf > gpu::kSmallestPdf) || !(glm::dot(direction, s.geometric) > 0.0f))
            return result;
        throughput *= f.value / f.pdf;
        pdf = f.pdf;
        if (bounce + 1 >= kRouletteBounce) {
            const float survival =
                std::min(std::sqrt(std::max({throughput.x, throughput.y, throughput.z})), 1.0f);
            if (!(draw(2).y < survival))
                return result;
            throughput /= survival;
        }
    }
}

} // namespace

CpuImage renderOnCpu(const Scene& scene, const Camera& camera, const ReferenceSettings& settings)
{
    Tracer tracer(scene, settings);
    const gpu::CameraRays rays = cameraRays(camera, settings.width, settings.height);
    CpuImage image(settings.width, settings.height);
    for (std::uint32_t pixel = 0; pixel < settings.width * settings.height; ++pixel) {
        const glm::vec2 shift(gpu::uniform3(pixel, 0, 0, settings.seed));
        const glm::vec2 corner(float(pixel % settings.width), float(pixel / settings.width));
        glm::vec3 sum(0.0f);
        for (std::uint32_t sample = 0; sample < settings.samples; ++sample) {
            const glm::vec2 point = corner + gpu::sequencePoint(sample, shift);
            sum += tracer.radiance(rays.eye, gpu::cameraRayDirection(rays, point), pixel, sample);
        }
        image.pixels[pixel] = glm::vec4(sum / float(settings.samples), 1.0f);
    }
    return image;
}

} // namespace strandlight
