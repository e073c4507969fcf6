#include "engine/scene/hair.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/error.hpp"
#include "shaders/shared/rng.h"

namespace strandlight {

namespace {

constexpr float kTaperStart = 0.75f;
constexpr float kTipRadius = 0.1f; // of the root's
constexpr float kCameraFovDegrees = 35.0f;
constexpr float kCameraMargin = 1.05f;
constexpr std::uint32_t kPaintDimension = 0x70616e74u; // apart from other uses of the same seed

bool isFinite(glm::vec3 v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isAlbedo(glm::vec3 v)
{
    const auto inside = [](float x) { return x >= 0.0f && x <= 1.0f; }; // false for NaN
    return inside(v.x) && inside(v.y) && inside(v.z);
}

void checkStrands(const HairStrands& hair)
{
    const auto refuse = [&](const std::string& reason) {
        throw Error("hair '" + hair.name + "': " + reason);
    };
    if (hair.firstPoint.size() < 2 || hair.firstPoint.front() != 0 ||
        hair.firstPoint.back() != hair.points.size())
        refuse("the first points of " + std::to_string(hair.strandCount()) +
               " strands do not enclose " + std::to_string(hair.points.size()) + " points");
    for (std::size_t s = 0; s + 1 < hair.firstPoint.size(); ++s) {
        const std::uint64_t first = hair.firstPoint[s];
        if (hair.firstPoint[s + 1] < first + 2)
            refuse("strand " + std::to_string(s) + " has fewer than two points");
    }
}

} // namespace

std::uint32_t HairStrands::strandCount() const
{
    return firstPoint.empty() ? 0u : static_cast<std::uint32_t>(firstPoint.size() - 1);
}

std::uint32_t HairStrands::segmentCount() const
{
    return static_cast<std::uint32_t>(points.size()) - strandCount();
}

glm::vec3 HairStrands::boundsMin() const
{
    glm::vec3 low = points.empty() ? glm::vec3(0.0f) : points.front();
    for (const glm::vec3& p : points)
        low = glm::min(low, p);
    return low;
}

glm::vec3 HairStrands::boundsMax() const
{
    glm::vec3 high = points.empty() ? glm::vec3(0.0f) : points.front();
    for (const glm::vec3& p : points)
        high = glm::max(high, p);
    return high;
}

void checkHair(const HairStrands& hair)
{
    const std::size_t count = hair.points.size();
    if (hair.radii.size() != count || hair.colors.size() != count)
        throw Error("hair '" + hair.name + "': " + std::to_string(count) + " points, " +
                    std::to_string(hair.radii.size()) + " radii, " +
                    std::to_string(hair.colors.size()) + " colours");
    checkStrands(hair);
    for (std::size_t i = 0; i < count; ++i) {
        const std::string place = "hair '" + hair.name + "': point " + std::to_string(i);
        if (!isFinite(hair.points[i]))
            throw Error(place + " is not finite");
        if (!(hair.radii[i] >= 0.0f) || !std::isfinite(hair.radii[i]))
            throw Error(place + " has the radius " + std::to_string(hair.radii[i]));
        if (!isAlbedo(hair.colors[i]))
            throw Error(place + " has a colour outside of 0 .. 1");
    }
}

HairStrands selectStrands(const HairStrands& hair, std::uint32_t count)
{
    const std::uint64_t total = hair.strandCount();
    if (count >= total)
        return hair;
    HairStrands part;
    part.name = hair.name;
    part.firstPoint.push_back(0);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t s = i * total / count;
        const auto first = static_cast<std::ptrdiff_t>(hair.firstPoint[s]);
        const auto last = static_cast<std::ptrdiff_t>(hair.firstPoint[s + 1]);
        const auto append = [&](auto& to, const auto& from) {
            to.insert(to.end(), from.begin() + first, from.begin() + last);
        };
        append(part.points, hair.points);
        append(part.radii, hair.radii);
        append(part.colors, hair.colors);
        part.firstPoint.push_back(static_cast<std::uint32_t>(part.points.size()));
    }
    return part;
}

float tipTaper(float t)
{
    const float end = std::clamp((t - kTaperStart) / (1.0f - kTaperStart), 0.0f, 1.0f);
    return 1.0f - (1.0f - kTipRadius) * end;
}

void paintHair(HairStrands& hair, glm::vec3 color, float variation, std::uint32_t seed)
{
    hair.colors.resize(hair.points.size());
    for (std::uint32_t s = 0; s < hair.strandCount(); ++s) {
        const glm::vec3 u = gpu::uniform3(s, 0u, kPaintDimension, seed);
        const float brightness = 1.0f + variation * (2.0f * u.x - 1.0f);
        const float warmth = 0.5f * variation * (2.0f * u.y - 1.0f);
        const glm::vec3 own = color * brightness * glm::vec3(1.0f + warmth, 1.0f, 1.0f - warmth);
        const std::uint32_t first = hair.firstPoint[s];
        const std::uint32_t segments = hair.firstPoint[s + 1] - first - 1;
        for (std::uint32_t i = 0; i <= segments; ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(segments);
            const float along = 1.0f + variation * (t - 0.5f);
            hair.colors[first + i] = glm::clamp(own * along, glm::vec3(0.0f), glm::vec3(1.0f));
        }
    }
}

Camera hairCamera(const HairStrands& hair)
{
    const glm::vec3 centre = 0.5f * (hair.boundsMin() + hair.boundsMax());
    float radius = 1e-3f; // a groom of one place must not hold the camera
    for (const glm::vec3& p : hair.points)
        radius = std::max(radius, glm::length(p - centre));
    Camera camera;
    camera.verticalFovDegrees = kCameraFovDegrees;
    camera.target = centre;
    const float distance =
        kCameraMargin * radius / std::sin(0.5f * glm::radians(kCameraFovDegrees));
    camera.eye = camera.target + distance * glm::normalize(glm::vec3(0.45f, 0.2f, 1.0f));
    return camera;
}

} // namespace strandlight
