#include "engine/scene/grooms_growth.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/scene/hair_head.hpp"
#include "shaders/shared/rng.h"

namespace strandlight {

namespace {

constexpr float kTwoPi = 6.2831853f;
constexpr glm::vec3 kDown{0.0f, -1.0f, 0.0f};
constexpr glm::vec3 kTie{0.0f, 0.035f, -0.112f}; // where a ponytail is tied
constexpr float kTieRadius = 0.014f;
constexpr float kLayer = 0.012f;        // metres: outermost hair lies this far above the scalp
constexpr std::uint32_t kLockSize = 80; // strands that share a lock
constexpr std::uint32_t kMostLocks = 512;
constexpr float kOutside = 1.0f - 1e-6f; // head level that rounding may leave on the surface

// What the random numbers are for; the counter is (strand, step, use).
enum Use : std::uint32_t
{
    kUseRoot = 1,
    kUseStrand = 2,
    kUseFrizz = 3,
    kUseLock = 4
};

// Unit vector at a right angle to unit `d`, close to `hint` where that is possible.
glm::vec3 sideOf(glm::vec3 d, glm::vec3 hint)
{
    glm::vec3 side = hint - d * glm::dot(d, hint);
    if (glm::dot(side, side) < 1e-6f) {
        const glm::vec3 other = std::abs(d.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
        side = other - d * glm::dot(d, other);
    }
    return glm::normalize(side);
}

// Where hair grows, by direction from the head's centre: a high forehead, ears free, low in the
// neck.
bool isScalp(glm::vec3 direction)
{
    const float front = std::clamp(0.5f + 0.9f * direction.z, 0.0f, 1.0f);
    return direction.y > -0.45f + 0.9f * front;
}

glm::vec3 rootOf(std::uint32_t strand, std::uint32_t use, std::uint32_t seed)
{
    for (std::uint32_t attempt = 0; attempt < 64; ++attempt) {
        const glm::vec3 u = gpu::uniform3(strand, attempt, use, seed);
        const float y = 2.0f * u.x - 1.0f;
        const float ring = std::sqrt(std::max(0.0f, 1.0f - y * y));
        const float angle = kTwoPi * u.y;
        const glm::vec3 direction(ring * std::cos(angle), y, ring * std::sin(angle));
        if (isScalp(direction))
            return direction * kHeadRadii;
    }
    return {0.0f, kHeadRadii.y, 0.0f}; // one in 10^20
}

// Direction of length 1 for a step from `from` that does not enter the head: `wanted`, turned
// towards the tangent plane as little as needed. The plane through `from` never enters a convex
// head.
glm::vec3 stayOutside(glm::vec3 from, glm::vec3 wanted, float step)
{
    if (lowestHeadLevel(from, from + step * wanted) >= kOutside)
        return wanted;
    const glm::vec3 normal = headNormal(from);
    const glm::vec3 tangent = sideOf(normal, wanted);
    float good = 1.0f; // part of the tangent
    float bad = 0.0f;
    for (int i = 0; i < 6; ++i) {
        const float middle = 0.5f * (good + bad);
        const glm::vec3 d = glm::normalize(glm::mix(wanted, tangent, middle));
        (lowestHeadLevel(from, from + step * d) >= kOutside ? good : bad) = middle;
    }
    return good < 1.0f ? glm::normalize(glm::mix(wanted, tangent, good)) : tangent;
}

// One strand while it grows.
struct Strand
{
    glm::vec3 root;
    glm::vec3 position;
    glm::vec3 axis; // of the curl; the direction of a strand without one
    glm::vec3 side; // turns with the axis
    float step;     // metres
    float phase;    // of the curl
    float layer;    // 0 .. 1 of kLayer
    glm::vec3 tie;  // where it passes through the tie
    bool isTied = false;
};

// The lock that a strand belongs to; no points: none.
struct Lock
{
    std::span<const glm::vec3> points;
    float phase = 0.0f;
};

class Grower
{
public:
    Grower(const GroomShape& shape, const GroomSettings& settings)
        : shape_(shape), settings_(settings)
    {
    }

    void grow(std::uint32_t index, Use use, const Lock& lock, glm::vec3 root,
              std::span<glm::vec3> points) const
    {
        Strand strand = start(index, use, lock, root);
        points[0] = root;
        for (std::uint32_t i = 0; i < settings_.segments; ++i) {
            const float t = float(i + 1) / static_cast<float>(settings_.segments);
            turnAxis(strand, index, use, i);
            if (!lock.points.empty())
                turnToLock(strand, lock, i, t);
            const glm::vec3 wanted = curl(strand, i);
            const glm::vec3 taken = stayOutside(strand.position, wanted, strand.step);
            if (taken != wanted)
                strand.axis = taken; // slides on
            strand.position += strand.step * taken;
            points[i + 1] = strand.position;
        }
    }

private:
    Strand start(std::uint32_t index, Use use, const Lock& lock, glm::vec3 root) const
    {
        const glm::vec3 u = gpu::uniform3(index, use, kUseStrand, settings_.seed);
        const glm::vec3 v = gpu::uniform3(index, use + 16u, kUseStrand, settings_.seed);
        const glm::vec3 normal = headNormal(root);
        // Combed away from a parting in the middle, and back.
        const glm::vec3 comb(root.x >= 0.0f ? 1.0f : -1.0f, -0.2f, root.z > 0.0f ? 0.1f : -0.5f);
        Strand strand;
        strand.root = root;
        strand.position = root;
        strand.axis = glm::normalize(shape_.lift * normal + sideOf(normal, comb));
        strand.side = sideOf(strand.axis, {0.0f, 0.0f, 1.0f});
        strand.step = settings_.lengthMetres * (1.0f - settings_.lengthVariation * u.x) /
                      static_cast<float>(settings_.segments);
        const bool isFree = lock.points.empty();
        strand.phase = isFree ? kTwoPi * u.y : lock.phase + settings_.frizz * kTwoPi * (u.y - 0.5f);
        strand.layer = u.z;
        const float angle = kTwoPi * v.x;
        strand.tie =
            kTie + kTieRadius * std::sqrt(v.y) * glm::vec3(std::cos(angle), std::sin(angle), 0.0f);
        return strand;
    }

    void turnAxis(Strand& strand, std::uint32_t index, Use use, std::uint32_t i) const
    {
        glm::vec3 pull = shape_.gravity * kDown;
        if (shape_.isTied && !strand.isTied) {
            const glm::vec3 way = strand.tie - strand.position;
            const float distance = glm::length(way);
            strand.isTied = distance < 1.5f * strand.step;
            pull = way * (2.0f / (std::max(distance, 1e-4f) * strand.step));
            if (strand.isTied) // leaves the tie backwards
                pull = glm::vec3(0.0f, 0.4f, -1.0f) * (2.0f / strand.step);
        }
        glm::vec3 axis = strand.axis + strand.step * pull;
        // Hair of outer layers rests on the inner ones.
        const float height = (headLevel(strand.position) - 1.0f) * kHeadRadii.z;
        const float missing = 1.0f - height / (kLayer * strand.layer + 1e-5f);
        if (missing > 0.0f)
            axis += 0.5f * missing * headNormal(strand.position);
        const glm::vec3 u =
            gpu::uniform3(index, i * 2u + (use == kUseLock ? 1u : 0u), kUseFrizz, settings_.seed);
        axis += settings_.frizz * (2.0f * u - 1.0f);
        strand.axis = glm::dot(axis, axis) > 1e-8f ? glm::normalize(axis) : kDown;
        strand.side = sideOf(strand.axis, strand.side);
    }

    // Follows the lock's own strand at a distance that shrinks from root to tip.
    void turnToLock(Strand& strand, const Lock& lock, std::uint32_t i, float t) const
    {
        const glm::vec3 apart = strand.root - lock.points[0];
        const glm::vec3 way =
            lock.points[i + 1] + (1.0f - settings_.clumping * t) * apart - strand.position;
        const float distance = glm::length(way);
        if (distance > 0.1f * strand.step)
            strand.axis = glm::normalize(strand.axis + settings_.clumping * (way / distance));
    }

    glm::vec3 curl(const Strand& strand, std::uint32_t i) const
    {
        if (shape_.curlTilt == 0.0f)
            return strand.axis;
        const float pitch = std::max(shape_.curlPitch, 4.0f * strand.step);
        const float angle = strand.phase + kTwoPi * (float(i) + 0.5f) * strand.step / pitch;
        const glm::vec3 across = glm::cross(strand.axis, strand.side);
        if (shape_.isFlat) {
            const float tilt = shape_.curlTilt * std::cos(angle);
            return glm::normalize(std::cos(tilt) * strand.axis + std::sin(tilt) * strand.side);
        }
        const glm::vec3 round = std::cos(angle) * strand.side + std::sin(angle) * across;
        return glm::normalize(std::cos(shape_.curlTilt) * strand.axis +
                              std::sin(shape_.curlTilt) * round);
    }

    const GroomShape& shape_;
    const GroomSettings& settings_;
};

std::size_t nearest(const std::vector<glm::vec3>& roots, glm::vec3 root)
{
    std::size_t best = 0;
    float bestSquare = 1e30f;
    for (std::size_t k = 0; k < roots.size(); ++k) {
        const glm::vec3 apart = roots[k] - root;
        const float square = glm::dot(apart, apart);
        if (square < bestSquare) {
            bestSquare = square;
            best = k;
        }
    }
    return best;
}

} // namespace

void growStrands(const GroomShape& shape, const GroomSettings& settings,
                 std::span<glm::vec3> points)
{
    const Grower grower(shape, settings);
    const std::size_t perStrand = settings.segments + 1;
    const std::uint32_t locks =
        settings.clumping == 0.0f ? 0u : std::clamp(settings.strands / kLockSize, 1u, kMostLocks);
    std::vector<glm::vec3> lockRoots(locks);
    std::vector<glm::vec3> lockPoints(locks * perStrand);
    for (std::uint32_t k = 0; k < locks; ++k) {
        lockRoots[k] = rootOf(k, kUseLock, settings.seed);
        grower.grow(k, kUseLock, {}, lockRoots[k],
                    std::span(lockPoints).subspan(k * perStrand, perStrand));
    }
    for (std::uint32_t s = 0; s < settings.strands; ++s) {
        const glm::vec3 root = rootOf(s, kUseRoot, settings.seed);
        Lock lock;
        if (locks > 0) {
            const std::size_t k = nearest(lockRoots, root);
            lock.points = std::span<const glm::vec3>(lockPoints).subspan(k * perStrand, perStrand);
            lock.phase =
                kTwoPi * gpu::uniform3(std::uint32_t(k), kUseLock, kUseStrand, settings.seed).y;
        }
        grower.grow(s, kUseRoot, lock, root, points.subspan(s * perStrand, perStrand));
    }
}

} // namespace strandlight
