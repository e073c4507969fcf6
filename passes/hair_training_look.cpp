#include "passes/hair_training_look.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/scene/hair.hpp"
#include "shaders/shared/rng.h"

namespace strandlight {
namespace {

constexpr float kTwoPi = 6.2831853f;
constexpr float kFovDegrees = 25.0f; // far enough away that no strand fills the picture
constexpr std::uint32_t kLookDimension = 0x6c6f6f6bu; // apart from other uses of the same seed
constexpr std::uint32_t kMostSegments = 180000;       // raster time goes by segments
constexpr std::uint32_t kHeldOutFrames = 0x80000000u;

// Linear albedos from black to platinum.
constexpr std::array<glm::vec3, 7> kNatural = {{{0.05f, 0.04f, 0.035f},
                                                {0.1f, 0.065f, 0.045f},
                                                {0.28f, 0.14f, 0.07f},
                                                {0.45f, 0.16f, 0.06f},
                                                {0.62f, 0.42f, 0.22f},
                                                {0.8f, 0.66f, 0.45f},
                                                {0.55f, 0.54f, 0.52f}}};

class Draws
{
public:
    Draws(std::uint32_t seed, std::uint32_t item) : seed_(seed), item_(item) {}

    float uniform() { return gpu::uniform3(item_, next_++, kLookDimension, seed_).x; }
    float between(float low, float high) { return low + (high - low) * uniform(); }
    float logBetween(float low, float high) { return low * std::pow(high / low, uniform()); }
    std::uint32_t below(std::uint32_t count) { return std::uint32_t(uniform() * float(count)); }
    bool chance(float probability) { return uniform() < probability; }
    glm::vec3 tint(float least)
    {
        const float r = between(least, 1.0f), g = between(least, 1.0f), b = between(least, 1.0f);
        return {r, g, b};
    }
    glm::vec3 direction(float lowDegrees, float highDegrees) // elevation
    {
        const float azimuth = kTwoPi * uniform();
        const float elevation = glm::radians(between(lowDegrees, highDegrees));
        return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                std::cos(elevation) * std::cos(azimuth)};
    }

private:
    std::uint32_t seed_, item_;
    std::uint32_t next_ = 0;
};

std::string drawStyle(Draws& draws, std::uint32_t index, bool heldOut)
{
    if (heldOut && index % 3 == 0)
        return kHeldOutStyle;
    std::vector<std::string> styles;
    for (const std::string& name : groomNames())
        if (name != kHeldOutStyle)
            styles.push_back(name);
    return styles[draws.below(std::uint32_t(styles.size()))];
}

// Strands from 0.02 to 1 pixel wide, and so many that raster time stays in hand: a close view draws
// a part of them only.
void drawView(Draws& draws, HairTrainingLook& look)
{
    const float kind = draws.uniform();
    GroomSettings& groom = look.groom;
    if (kind < 0.4f) {
        look.viewHeight = draws.logBetween(0.06f, 0.14f);
        groom.strands = std::uint32_t(draws.logBetween(12000.0f, 32000.0f));
    } else if (kind < 0.75f) {
        look.viewHeight = draws.logBetween(0.14f, 0.3f);
        groom.strands = std::uint32_t(draws.logBetween(8000.0f, 20000.0f));
        look.aimShare = 0.8f;
    } else {
        look.viewHeight = draws.logBetween(0.3f, 0.45f);
        groom.strands = std::uint32_t(draws.logBetween(10000.0f, 30000.0f));
        look.aimShare = 0.4f;
    }
    look.viewDirection = draws.direction(-25.0f, 55.0f);
    look.aim = {draws.uniform(), draws.uniform()};
}

void drawGroom(Draws& draws, HairTrainingLook& look, std::uint32_t groomSeed)
{
    GroomSettings& groom = look.groom;
    groom.seed = groomSeed;
    groom.segments = std::uint32_t(float(groom.segments) * draws.between(0.55f, 0.85f));
    groom.strands = std::min(groom.strands, kMostSegments / groom.segments);
    groom.lengthMetres *= draws.between(0.6f, 1.3f);
    groom.lengthVariation = draws.between(0.05f, 0.6f);
    groom.radiusMetres = draws.logBetween(2e-5f, 1.1e-4f);
    groom.clumping = draws.between(0.0f, 0.9f);
    groom.frizz *= draws.between(0.3f, 2.0f);
    groom.frizz = std::min(groom.frizz, 1.0f);
    const glm::vec3 any = draws.tint(0.02f);
    const std::uint32_t natural = draws.below(std::uint32_t(kNatural.size()));
    groom.color = draws.chance(0.25f) ? any : kNatural[natural] * draws.tint(0.8f);
    groom.colorVariation = draws.between(0.0f, 0.8f);
}

PunctualLight drawLight(Draws& draws)
{
    PunctualLight light;
    light.type = LightType::Directional;
    light.direction = -draws.direction(-15.0f, 80.0f);
    const float lux = draws.logBetween(0.7f, 5.0f);
    light.intensity = lux * draws.tint(0.7f);
    return light;
}

} // namespace

HairTrainingLook hairTrainingLook(std::uint32_t seed, std::uint32_t index, bool heldOut)
{
    const std::uint32_t item = index + (heldOut ? kHeldOutFrames : 0u);
    Draws draws(seed, item);
    HairTrainingLook look;
    look.style = drawStyle(draws, index, heldOut);
    look.groom = groomSettings(look.style);
    drawView(draws, look);
    drawGroom(draws, look, gpu::hashPcg(item ^ gpu::hashPcg(seed)));
    look.head = draws.chance(0.75f);
    const std::uint32_t lights = draws.chance(0.4f) ? 2 : 1;
    for (std::uint32_t i = 0; i < lights; ++i)
        look.lights.push_back(drawLight(draws));
    const float ambient = draws.logBetween(0.04f, 0.5f);
    look.ambient = ambient * draws.tint(0.6f);
    look.roughness = draws.between(0.15f, 0.55f);
    return look;
}

Camera hairTrainingCamera(const HairTrainingLook& look, const HairStrands& hair)
{
    const glm::vec3 middle = 0.5f * (hair.boundsMin() + hair.boundsMax());
    const auto strand = std::uint32_t(look.aim.x * float(hair.strandCount()));
    const std::uint32_t first = hair.firstPoint[strand];
    const std::uint32_t points = hair.firstPoint[strand + 1] - first;
    const glm::vec3 place = hair.points[first + std::uint32_t(look.aim.y * float(points))];
    Camera camera;
    camera.verticalFovDegrees = kFovDegrees;
    camera.target = glm::mix(middle, place, look.aimShare);
    const float distance = 0.5f * look.viewHeight / std::tan(0.5f * glm::radians(kFovDegrees));
    camera.eye = camera.target + distance * look.viewDirection;
    return camera;
}

} // namespace strandlight
