#include "tests/support/synthetic_lightfield.hpp"

#include <algorithm>
#include <cmath>

#include "shaders/shared/octahedral.h"

namespace strandlight::test {
namespace {

using glm::vec3;

constexpr float kNearest = 1.0e-4f;

// Lowers `distance` to the hit of a sphere; false: no nearer hit.
bool hitSphere(const vec3& origin, const vec3& direction, const vec3& centre, float radius,
               float& distance)
{
    const vec3 q = origin - centre;
    const float b = dot(q, direction);
    const float discriminant = b * b - dot(q, q) + radius * radius;
    if (discriminant < 0.0f)
        return false;
    const float t = -b - std::sqrt(discriminant);
    if (t < kNearest || t >= distance)
        return false;
    distance = t;
    return true;
}

bool hitBox(const vec3& origin, const vec3& direction, const vec3& low, const vec3& high,
            float& distance)
{
    float enter = kNearest, leave = distance;
    for (int i = 0; i < 3; ++i) {
        const float inverse = 1.0f / (std::abs(direction[i]) < 1e-9f ? 1e-9f : direction[i]);
        const float a = (low[i] - origin[i]) * inverse, b = (high[i] - origin[i]) * inverse;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
        if (enter > leave)
            return false;
    }
    distance = enter;
    return true;
}

// Room [-1,1]^2 x [0,1.4].
vec3 roomRadiance(const vec3& origin, const vec3& direction, float lights)
{
    const auto wall = [](float o, float d, float high) {
        return d > 0.0f ? (high - o) / d : d < 0.0f ? (-1.0f - o) / d : 1e9f;
    };
    const float x = wall(origin.x, direction.x, 1.0f);
    const float y = wall(origin.y, direction.y, 1.0f);
    const float z = direction.z > 0.0f ? (1.4f - origin.z) / direction.z : 1e9f;
    float distance = std::min({x, y, z});
    const vec3 p = origin + direction * distance;
    vec3 color(0.35f, 0.35f, 0.38f); // ceiling
    if (distance == x && direction.x > 0.0f) {
        const bool window = std::abs(p.y - 0.2f) < 0.35f && p.z > 0.4f && p.z < 1.1f;
        color = window ? vec3(6.0f, 7.0f, 9.0f) * lights : vec3(0.5f);
    } else if (distance == x) {
        color = vec3(0.7f, 0.12f, 0.1f);
    } else if (distance == y) {
        color = direction.y > 0.0f ? vec3(0.1f, 0.5f, 0.12f) : vec3(0.45f, 0.42f, 0.4f);
    }
    if (hitSphere(origin, direction, vec3(-0.3f, -0.4f, 0.9f), 0.12f, distance))
        color = vec3(10.0f, 7.0f, 3.0f) * lights;
    if (hitBox(origin, direction, vec3(-0.1f, 0.1f, 0.0f), vec3(0.15f, 0.35f, 0.8f), distance))
        color = vec3(0.15f, 0.1f, 0.08f);
    return color;
}

void appendImage(const SyntheticRoom& room, const vec3& point, std::vector<std::uint32_t>& words)
{
    const float size = float(room.size);
    for (std::uint32_t y = 0; y < room.size; ++y) {
        for (std::uint32_t x = 0; x < room.size; ++x) {
            vec3 sum(0.0f);
            for (int ray = 0; ray < 16; ++ray) {
                const glm::vec2 inside((float(ray & 3) + 0.5f) / 4.0f,
                                       (float(ray >> 2) + 0.5f) / 4.0f);
                const glm::vec2 uv = (glm::vec2(x, y) + inside) / size;
                sum += roomRadiance(point, gpu::hemiOctDecode(uv), room.lights);
            }
            words.push_back(gpu::packRgb9e5(sum / 16.0f));
        }
    }
}

vec3 gridPoint(const SyntheticRoom& room, float x, float y)
{
    const float pitch = room.extent / float(room.grid - 1);
    return {x * pitch - 0.5f * room.extent, y * pitch - 0.5f * room.extent, 0.01f};
}

} // namespace

Atlas gridAtlas(std::uint32_t grid)
{
    Atlas atlas;
    atlas.resolution = grid + 4;
    atlas.chartCount = 1;
    for (std::uint32_t y = 0; y < grid; ++y) {
        for (std::uint32_t x = 0; x < grid; ++x) {
            AtlasTexel texel;
            texel.x = x + 2;
            texel.y = y + 2;
            atlas.texels.push_back(texel);
        }
    }
    return atlas;
}

CpuLightfield roomLightfield(const SyntheticRoom& room)
{
    CpuLightfield field;
    field.size = room.size;
    field.texelCount = room.grid * room.grid;
    field.valid.assign(field.texelCount, 1);
    for (std::uint32_t y = 0; y < room.grid; ++y)
        for (std::uint32_t x = 0; x < room.grid; ++x)
            appendImage(room, gridPoint(room, float(x), float(y)), field.radiance);
    return field;
}

void captureRoomProbes(const SyntheticRoom& room, const Atlas& atlas, FitProbes& probes)
{
    probes.images.clear();
    for (std::size_t p = 0; p < probes.texels.size(); ++p) {
        glm::vec2 place(0.0f);
        for (int c = 0; c < 4; ++c) {
            const AtlasTexel& texel = atlas.texels[probes.texels[p][c]];
            place += probes.weights[p][c] * (glm::vec2(texel.x, texel.y) - 2.0f);
        }
        appendImage(room, gridPoint(room, place.x, place.y), probes.images);
    }
}

} // namespace strandlight::test
